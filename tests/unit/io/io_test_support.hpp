// SPDX-License-Identifier: MIT
/// @file
/// What the tests of files share: a folder that vanishes, whole files as bytes, the text of a refusal, .npy images built
/// independently of the library.
#pragma once

#include <support/refusal.hpp>
#include <support/temporary_folder.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace io_test {

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

using softtissue_test::refusal;
using softtissue_test::TemporaryFolder;

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A .npy file of format version 1 with this dictionary text and these data bytes.
inline std::string npy_image(const std::string& dictionary, const std::string& data) {
    std::string image("\x93NUMPY\x01\x00", 8);
    const std::string header = dictionary + "\n";
    image += char(header.size() % 256);
    image += char(header.size() / 256);
    return image + header + data;
}

inline std::vector<unsigned char> as_bytes(const std::string& text) {
    return {text.begin(), text.end()};
}

/// The memory of `values`, element by element.
template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

}  // namespace io_test
