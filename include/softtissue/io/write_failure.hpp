// SPDX-License-Identifier: MIT
/// @file
/// Why a file or folder could not be written, and what to do about it.
///
/// What        one sentence: its name, the system's reason, advice where there is some
/// Tests       tests/unit/io/write_failure_test.cpp
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

namespace softtissue {

namespace detail {

/// Of an error of the system (errno).
inline const char* advice_on_writing(int error) {
    switch (error) {
        case ENOSPC:
#if defined(EDQUOT)
        case EDQUOT:
#endif
            return "; make room there and write again";
        case EFBIG:
            return "; allow larger files (ulimit -f) and write again";
        case EACCES:
        case EPERM:
        case EROFS:
            return "; choose a place that you may write to";
        case ENOENT:
        case ENOTDIR:
            return "; make its folder first";
        case EMFILE:
        case ENFILE:
            return "; close files, or allow more open ones (ulimit -n)";
        case ENOMEM:
            return "; give the process more memory";
        default:
            return "";
    }
}

}  // namespace detail

/// `error`: errno; 0 where the system has not told.
inline std::string write_failure(const std::filesystem::path& path, int error) {
    std::string text = path.string() + ": cannot write";
    if (error != 0) {
        text += std::string(": ") + std::strerror(error) + detail::advice_on_writing(error);
    }
    return text;
}

}  // namespace softtissue
