// SPDX-License-Identifier: MIT
/// @file
/// A new folder, removed with its content at the end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>

namespace softtissue_test {

class TemporaryFolder {
public:
    TemporaryFolder() {
        int attempt = 0;
        do {
            path_ = std::filesystem::temp_directory_path() / ("softtissue_test_" + std::to_string(attempt++));
        } while (!std::filesystem::create_directory(path_));
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

    std::size_t num_files() const {
        return std::size_t(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

}  // namespace softtissue_test
