// SPDX-License-Identifier: MIT
/// @file
/// An output file that appears complete or not at all.
///
/// What        collects the content under a temporary name in the same folder; commit() flushes, closes and renames.
///             Without commit() (an exception on the way) nothing remains and an older file of that name is untouched.
/// Refuses     a folder that does not exist or cannot be written, a full disk, a name that is a folder
///             (InvalidInput names the file and the system's reason).
/// Tests       tests/unit/io/atomic_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace softtissue {

class AtomicFile {
public:
    /// Reserves a temporary name beside `path`.
    explicit AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
        require(path_.has_filename() && !std::filesystem::is_directory(path_), path_.string(),
                ": cannot write, expected the name of a file, not of a folder");
        std::FILE* reserved = nullptr;
        for (int attempt = 0; attempt < max_attempts && reserved == nullptr; ++attempt) {
            temporary_ = path_;
            temporary_ += ".part" + std::to_string(attempt);
            reserved = std::fopen(temporary_.string().c_str(), "wbx");
            require(reserved != nullptr || errno == EEXIST, path_.string(), ": cannot write: ", std::strerror(errno));
        }
        require(reserved != nullptr, path_.string(), ": cannot write, ", max_attempts,
                " abandoned temporary files (.part0, ...) lie beside it");
        std::fclose(reserved);
    }

    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    ~AtomicFile() {
        if (file_ != nullptr) {
            std::fclose(file_);
        }
        if (!committed_) {
            std::error_code ignored;
            std::filesystem::remove(temporary_, ignored);
        }
    }

    const std::filesystem::path& path() const { return path_; }

    /// For libraries that write by name: write there instead of calling write(), then commit().
    const std::filesystem::path& temporary_path() const { return temporary_; }

    void write(const void* data, std::size_t size) {
        if (file_ == nullptr) {
            file_ = std::fopen(temporary_.string().c_str(), "wb");
            require_done(file_ != nullptr);
        }
        require_done(size == 0 || std::fwrite(data, 1, size, file_) == size);
    }

    void write(std::string_view text) { write(text.data(), text.size()); }

    /// Makes the file visible under its name, replacing an older one.
    void commit() {
        if (file_ != nullptr) {
            std::FILE* const file = file_;
            file_ = nullptr;
            const bool flushed = std::fflush(file) == 0;
            const int flush_error = errno;
            const bool closed = std::fclose(file) == 0;
            if (!flushed) {
                errno = flush_error;
            }
            require_done(flushed && closed);
        }
        std::error_code error;
        std::filesystem::rename(temporary_, path_, error);
        require(!error, path_.string(), ": cannot write: ", error.message());
        committed_ = true;
    }

private:
    static constexpr int max_attempts = 1000;

    void require_done(bool done) const {
        if (!done) {
            throw_invalid_input(path_.string(), ": cannot write: ", std::strerror(errno));
        }
    }

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::FILE* file_ = nullptr;
    bool committed_ = false;
};

}  // namespace softtissue
