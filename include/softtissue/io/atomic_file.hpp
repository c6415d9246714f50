// SPDX-License-Identifier: MIT
/// @file
/// An output file that appears complete or not at all.
///
/// What        collects the content under a temporary name in the same folder (NAME.part0, ...); commit() flushes, closes and
///             renames. Without commit() (an exception on the way) nothing remains and an older file of that name is untouched.
///             What a killed process has left under a temporary name is taken over by the next writer of that file. A
///             symbolic link stays: the file that it leads to is replaced.
/// Valid       in whatever way the process ends, with several of them writing at once: the last commit() wins. Not against
///             loss of power, since nothing waits for the disk.
/// Refuses     a folder that does not exist or cannot be written, a full disk, a name that is a folder or a device
///             (InvalidInput names the file, the system's reason and what to do).
/// Tests       tests/unit/io/atomic_file_test.cpp, tests/faults/
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/io/file_claim.hpp>
#include <softtissue/io/write_failure.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace softtissue {

class AtomicFile {
public:
    /// Reserves a temporary name beside `path`.
    explicit AtomicFile(std::filesystem::path path) : path_(std::move(path)), target_(followed(path_)) {
        std::error_code ignored;
        const std::filesystem::file_status status = std::filesystem::status(target_, ignored);
        require(path_.has_filename() && (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)),
                path_.string(), ": cannot write, expected the name of a file, not of a folder or device");
        for (int attempt = 0; attempt < max_attempts; ++attempt) {
            temporary_ = target_;
            temporary_ += ".part" + std::to_string(attempt);
            claim_ = FileClaim(temporary_);
            if (claim_.is_held()) {
                return;  // nothing more may throw here: the destructor would not run
            }
            require(claim_.error() == EEXIST, write_failure(path_, claim_.error()));
        }
        throw_invalid_input(path_.string(), ": cannot write, ", max_attempts,
                            " temporary files (.part0, ...) lie beside it; remove those that nobody is writing");
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

    /// For libraries that write by name: write there instead of calling write(), then require_written() and commit().
    const std::filesystem::path& temporary_path() const { return temporary_; }

    /// Throws unless `done`, with what the system has told last.
    void require_written(bool done) const {
        if (!done) {
            throw_invalid_input(write_failure(path_, errno));
        }
    }

    void write(const void* data, std::size_t size) {
        if (file_ == nullptr) {
            file_ = std::fopen(temporary_.string().c_str(), "wb");
            require_written(file_ != nullptr);
        }
        require_written(size == 0 || std::fwrite(data, 1, size, file_) == size);
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
            require_written(flushed && closed);
        }
        std::error_code error;
        std::filesystem::rename(temporary_, target_, error);
        committed_ = !error;
        if (error) {
            throw_invalid_input(write_failure(path_, error.value()));
        }
    }

private:
    static constexpr int max_attempts = 1000;

    /// Where a link leads that leads to something.
    static std::filesystem::path followed(const std::filesystem::path& path) {
        std::error_code error;
        const bool is_link = std::filesystem::is_symlink(std::filesystem::symlink_status(path, error));
        const std::filesystem::path end = is_link ? std::filesystem::canonical(path, error) : path;
        return error ? path : end;
    }

    std::filesystem::path path_, target_, temporary_;
    FileClaim claim_;
    std::FILE* file_ = nullptr;
    bool committed_ = false;
};

}  // namespace softtissue
