// SPDX-License-Identifier: MIT
/// @file
/// The file that a program writes at its end: refused before the work rather than after it.
#pragma once

#include <softtissue/io/atomic_file.hpp>

#include <filesystem>

namespace examples {

/// Throws InvalidInput with the system's reason where `path` cannot be written. What stands there stays as it is.
inline void require_writable(const std::filesystem::path& path) {
    static_cast<void>(softtissue::AtomicFile(path));
}

}  // namespace examples
