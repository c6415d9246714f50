// SPDX-License-Identifier: MIT
/// @file
/// A file of a process's own, told from those that killed processes have left.
///
/// What        makes an empty file, or takes over and empties one that lies there and that no living process has claimed.
///             The claim ends with the object, and with its process in whatever way that ends; the file stays.
/// Valid       among all processes that see the file system's locks (flock). Where there are none, nothing that exists is
///             taken over.
/// Refuses     nothing: is_held() tells, and error() why not (errno; EEXIST: it is another's, or no plain file)
/// Tests       tests/unit/io/file_claim_test.cpp
#pragma once

#if __has_include(<sys/file.h>) && __has_include(<unistd.h>)
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace softtissue {

enum class ClaimKind { make_or_take_over, take_over };

class FileClaim {
public:
    FileClaim() = default;

    explicit FileClaim(const std::filesystem::path& path, ClaimKind kind = ClaimKind::make_or_take_over) {
        const std::string name = path.string();
        for (int attempt = 0; attempt < max_attempts && !is_held_ && (error_ == 0 || error_ == EAGAIN); ++attempt) {
            try_to_hold(name, kind);  // again where the file has vanished in between
        }
    }

    FileClaim(const FileClaim&) = delete;
    FileClaim& operator=(const FileClaim&) = delete;
    FileClaim(FileClaim&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)),
          is_held_(std::exchange(other.is_held_, false)),
          error_(other.error_) {}
    FileClaim& operator=(FileClaim&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        std::swap(is_held_, other.is_held_);
        std::swap(error_, other.error_);
        return *this;
    }
    ~FileClaim() { close_descriptor(); }

    bool is_held() const { return is_held_; }
    int error() const { return error_; }

private:
    static constexpr int max_attempts = 100;

#if __has_include(<sys/file.h>) && __has_include(<unistd.h>)
    void try_to_hold(const std::string& name, ClaimKind kind) {
        constexpr int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
        close_descriptor();
        bool is_new = kind == ClaimKind::make_or_take_over;
        descriptor_ = is_new ? ::open(name.c_str(), flags | O_CREAT | O_EXCL, 0666) : -1;
        if (is_new && descriptor_ < 0 && errno != EEXIST) {
            error_ = errno;
            return;
        }
        if (descriptor_ < 0) {
            is_new = false;
            descriptor_ = ::open(name.c_str(), flags);
        }
        if (descriptor_ < 0) {
            error_ = errno != ENOENT ? EEXIST : kind == ClaimKind::take_over ? ENOENT : EAGAIN;
            return;
        }
        const bool is_locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
        if (!is_locked && (!is_new || errno == EWOULDBLOCK)) {
            error_ = EEXIST;
            return;
        }
        // Its former owner may have renamed or removed it before this lock was there.
        struct stat mine {};
        struct stat there {};
        const bool is_there = ::fstat(descriptor_, &mine) == 0 && ::lstat(name.c_str(), &there) == 0 &&
                              mine.st_ino == there.st_ino && mine.st_dev == there.st_dev;
        error_ = !is_there ? EAGAIN : !S_ISREG(mine.st_mode) || ::ftruncate(descriptor_, 0) != 0 ? EEXIST : 0;
        is_held_ = error_ == 0;
    }

    void close_descriptor() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
            descriptor_ = -1;
        }
    }
#else
    void try_to_hold(const std::string& name, ClaimKind kind) {
        std::FILE* const file = kind == ClaimKind::take_over ? nullptr : std::fopen(name.c_str(), "wbx");
        error_ = file != nullptr ? 0 : kind == ClaimKind::take_over ? EEXIST : errno;
        is_held_ = file != nullptr;
        if (file != nullptr) {
            std::fclose(file);
        }
    }

    void close_descriptor() {}
#endif

    int descriptor_ = -1;
    bool is_held_ = false;
    int error_ = 0;
};

/// Removes a file that a process has left behind, unless one that lives has claimed it; whether it did.
inline bool remove_abandoned(const std::filesystem::path& path) {
    const FileClaim claim(path, ClaimKind::take_over);
    std::error_code error;
    return claim.is_held() && std::filesystem::remove(path, error);
}

}  // namespace softtissue
