// SPDX-License-Identifier: MIT
/// @file
/// A folder for results, made and tried before the work that fills it.
///
/// What        makes the folder and those above it where they do not exist, and sees whether a file can be made in it.
/// Refuses     a folder that cannot be made or written, a name that is a file (InvalidInput names it and the system's reason)
/// Tests       tests/unit/io/output_folder_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/io/file_claim.hpp>
#include <softtissue/io/write_failure.hpp>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace softtissue {

inline void make_output_folder(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    require(!error, write_failure(path, error.value()));
    require(std::filesystem::is_directory(path), path.string(), ": cannot write, expected the name of a folder");
    const std::filesystem::path trial = path / ".softtissue_trial";
    const FileClaim claim(trial);
    require(claim.is_held() || claim.error() == EEXIST, write_failure(path, claim.error()));
    if (claim.is_held()) {
        std::filesystem::remove(trial, error);
    }
}

}  // namespace softtissue
