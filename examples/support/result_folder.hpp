// SPDX-License-Identifier: MIT
/// @file
/// The folder that a program fills with results: tried before the work, and no other program's meanwhile.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/io/folder_lock.hpp>
#include <softtissue/io/output_folder.hpp>

#include <filesystem>

namespace examples {

/// Keep it until the results are written. Two runs in one folder would leave files of both.
class ResultFolder {
public:
    explicit ResultFolder(const std::filesystem::path& path)
        : lock_(made(path), softtissue::LockKind::try_once) {
        softtissue::require(lock_.is_held(), path.string(),
                            ": another program writes its results there; wait for its end, or choose another folder");
    }

private:
    static const std::filesystem::path& made(const std::filesystem::path& path) {
        softtissue::make_output_folder(path);
        return path;
    }

    softtissue::FolderLock lock_;
};

}  // namespace examples
