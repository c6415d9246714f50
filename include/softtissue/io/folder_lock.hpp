// SPDX-License-Identifier: MIT
/// @file
/// One process at a time in a folder.
///
/// What        a lock on the folder, held until the object or its process ends, in whatever way; either waits until no other
///             holds it, or does without (is_held() tells).
/// Valid       among all processes that see the file system's locks (flock). Where there are none, everybody holds it.
/// Tests       tests/unit/io/folder_lock_test.cpp
#pragma once

#if __has_include(<sys/file.h>) && __has_include(<unistd.h>)
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <filesystem>

namespace softtissue {

enum class LockKind { wait, try_once };

class FolderLock {
public:
#if __has_include(<sys/file.h>) && __has_include(<unistd.h>)
    explicit FolderLock(const std::filesystem::path& path, LockKind kind = LockKind::wait)
        : descriptor_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        const int operation = kind == LockKind::wait ? LOCK_EX : LOCK_EX | LOCK_NB;
        int result = 0;
        do {
            result = descriptor_ >= 0 ? ::flock(descriptor_, operation) : 0;
        } while (result != 0 && errno == EINTR);
        is_held_ = result == 0 || errno != EWOULDBLOCK;
    }
    ~FolderLock() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
#else
    explicit FolderLock(const std::filesystem::path&, LockKind = LockKind::wait) {}
#endif
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    bool is_held() const {
        return is_held_;
    }

private:
#if __has_include(<sys/file.h>) && __has_include(<unistd.h>)
    int descriptor_;
#endif
    bool is_held_ = true;
};

}  // namespace softtissue
