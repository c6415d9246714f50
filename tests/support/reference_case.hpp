// SPDX-License-Identifier: MIT
// Finds a reference case, or says that it is not there.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <optional>
#include <string>

#if __has_include(<zip.h>)
#include <softtissue/io/npz.hpp>

namespace softtissue_test {

/// The arrays of reference/`name`, or nothing and a message.
inline std::optional<softtissue::NpzFile> reference_case(const std::string& name) {
    const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "reference" / name;
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: ", path.string(), " is not there");
        return std::nullopt;
    }
    return softtissue::read_npz(path);
}

}  // namespace softtissue_test
#endif
