// SPDX-License-Identifier: MIT
/// @file
/// Files that consist of parts with lengths and checksums: taken apart and put together, so that a change to one part leaves a
/// file that readers look into.
///
/// What        split() and join() of .npz (stored members only), .safetensors (header, elements) and .glb (JSON, binary chunk)
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softtissue_fuzz {

enum class Container { none, npz, safetensors, glb };

struct Part {
    std::string name;
    std::string bytes;
};

namespace detail {

inline std::string little_endian(std::uint64_t value, int bytes) {
    std::string text;
    for (int k = 0; k < bytes; ++k, value >>= 8U) {
        text += static_cast<char>(value & 0xFFU);
    }
    return text;
}

inline std::uint64_t number_at(std::string_view text, std::size_t place, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t k = bytes; k-- > 0;) {
        value = value << 8U | static_cast<unsigned char>(text[place + k]);
    }
    return value;
}

inline std::uint32_t checksum(std::string_view bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) {
            crc = crc >> 1U ^ ((crc & 1U) != 0U ? 0xEDB88320U : 0U);
        }
    }
    return ~crc;
}

inline std::optional<std::vector<Part>> split_zip(std::string_view file) {
    std::vector<Part> parts;
    std::size_t place = 0;
    while (file.size() - place >= 30 && file.substr(place, 4) == "PK\x03\x04") {
        const bool is_stored = number_at(file, place + 8, 2) == 0 && (number_at(file, place + 6, 2) & 8U) == 0;
        const std::size_t size = number_at(file, place + 18, 4);
        const std::size_t name = number_at(file, place + 26, 2);
        const std::size_t begin = 30 + name + number_at(file, place + 28, 2);
        if (!is_stored || begin > file.size() - place || size > file.size() - place - begin) {
            return std::nullopt;
        }
        parts.push_back({std::string(file.substr(place + 30, name)), std::string(file.substr(place + begin, size))});
        place += begin + size;
    }
    return parts.empty() ? std::nullopt : std::optional(std::move(parts));
}

inline std::string join_zip(const std::vector<Part>& parts) {
    std::string file, directory;
    for (const auto& [name, bytes] : parts) {
        constexpr std::uint64_t version = 20, first_of_january_1980 = 33;
        const std::string common = little_endian(version, 2) + little_endian(0, 6) +
                                   little_endian(first_of_january_1980, 2) + little_endian(checksum(bytes), 4) +
                                   little_endian(bytes.size(), 4) + little_endian(bytes.size(), 4) +
                                   little_endian(name.size(), 2) + little_endian(0, 2);
        directory += "PK\x01\x02" + little_endian(version, 2) + common + little_endian(0, 10) +
                     little_endian(file.size(), 4) + name;
        file += "PK\x03\x04" + common + name + bytes;
    }
    const std::string count = little_endian(parts.size(), 2);
    return file + directory + "PK\x05\x06" + little_endian(0, 4) + count + count + little_endian(directory.size(), 4) +
           little_endian(file.size(), 4) + little_endian(0, 2);
}

inline std::optional<std::vector<Part>> split_safetensors(std::string_view file) {
    if (file.size() < 8 || number_at(file, 0, 8) > file.size() - 8) {
        return std::nullopt;
    }
    const std::size_t header = number_at(file, 0, 8);
    return std::vector<Part>{{"header", std::string(file.substr(8, header))},
                             {"elements", std::string(file.substr(8 + header))}};
}

inline std::optional<std::vector<Part>> split_glb(std::string_view file) {
    if (file.size() < 20 || file.substr(0, 4) != "glTF" || number_at(file, 12, 4) > file.size() - 20) {
        return std::nullopt;
    }
    const std::size_t text = number_at(file, 12, 4);
    std::vector<Part> parts{{"JSON", std::string(file.substr(20, text))}};
    const std::string_view rest = file.substr(20 + text);
    if (rest.size() >= 8) {
        parts.push_back({std::string("BIN\0", 4), std::string(rest.substr(8))});
    }
    return parts;
}

inline std::string join_glb(const std::vector<Part>& parts) {
    std::string chunks;
    for (const auto& [name, bytes] : parts) {
        chunks += little_endian(bytes.size(), 4) + name + bytes;
    }
    return "glTF" + little_endian(2, 4) + little_endian(12 + chunks.size(), 4) + chunks;
}

}  // namespace detail

/// The parts of a file; nothing if it is none of the kind.
inline std::optional<std::vector<Part>> split(Container container, std::string_view file) {
    return container == Container::npz           ? detail::split_zip(file)
           : container == Container::safetensors ? detail::split_safetensors(file)
           : container == Container::glb         ? detail::split_glb(file)
                                                 : std::nullopt;
}

inline std::string join(Container container, const std::vector<Part>& parts) {
    if (container == Container::safetensors) {
        return detail::little_endian(parts[0].bytes.size(), 8) + parts[0].bytes + parts[1].bytes;
    }
    return container == Container::npz ? detail::join_zip(parts) : detail::join_glb(parts);
}

}  // namespace softtissue_fuzz
