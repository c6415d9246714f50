// SPDX-License-Identifier: MIT
/// @file
/// A glTF 2.0 file (.glb, .gltf) taken apart: its JSON text and the bytes of its buffers.
///
/// What        the JSON part, elements by kind and number, buffers inside the .glb, as data URIs or as files beside it, loaded
///             when they are first asked for.
/// Memory      file, JSON and buffers once
/// Refuses     anything that is no glTF 2.0, an extension that is required and not known, a chunk longer than the file, a buffer
///             shorter than it says, an address that is no relative file name (InvalidInput names file, element, value).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.6.1 (buffers), 4.4 (GLB)
/// Needs       nlohmann-json
/// Tests       tests/unit/io/gltf_container_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/json_element.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace softtissue {

namespace detail {

/// The bytes of base64 text; false if it is none.
inline bool decode_base64(std::string_view text, std::string& bytes) {
    while (!text.empty() && text.back() == '=') {
        text.remove_suffix(1);
    }
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> value_of{};
    value_of.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i) {
        value_of[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    }
    bytes.clear();
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int value = value_of[static_cast<unsigned char>(c)];
        if (value < 0) {
            return false;
        }
        bits = (bits << 6U | static_cast<std::uint32_t>(value)) & 0xFFFFFU;
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xFFU);
        }
    }
    return count < 6;
}

/// `text` with %20 and the like replaced.
inline std::string percent_decoded(const std::string& text) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
            result += static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2]));
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

}  // namespace detail

class GltfContainer {
public:
    static constexpr Index max_integer = Index(1) << 52;  ///< of sizes; sums of a few of them do not overflow

    explicit GltfContainer(const std::filesystem::path& path) : file_(path.string()), folder_(path.parent_path()) {
        const std::string bytes = read_file(path, file_);
        constexpr std::string_view magic = "glTF";
        const bool is_binary = std::string_view(bytes).substr(0, 4) == magic;
        const std::string_view text = is_binary ? read_chunks(bytes) : std::string_view(bytes);
        json_ = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
        require(json_.is_object(), file_, ": is no glTF file (neither .glb nor a JSON object)");
        loaded_bytes_ += static_cast<Index>(bytes.size());
        const std::string version = root().at("asset").at("version").text();
        require(version.starts_with("2."), file_, ": asset.version = ", version, ", expected 2.x");
        for (const JsonElement& name : root().items("extensionsRequired")) {
            require(is_known_extension(name.text()), name.name(), " = ", name.text(),
                    ", an extension that is not read; export without it (for compression: uncompressed)");
        }
    }

    const std::string& file() const { return file_; }
    JsonElement root() const { return {file_, json_}; }

    /// Number of elements of the top-level array `kind`.
    Index count(const std::string& kind) const { return root().has(kind) ? root().at(kind).size() : 0; }

    /// Element `number` of the top-level array `kind`.
    JsonElement element(const std::string& kind, Index number) const { return root().at(kind).at(number); }

    /// The element of `kind` that `reference` (an integer) means.
    Index index(const JsonElement& reference, const std::string& kind) const {
        require(count(kind) > 0, reference.name(), ": the file has no ", kind);
        return reference.integer(0, count(kind) - 1);
    }

    /// Bytes of the file and of the buffers beside it that were loaded.
    Index loaded_bytes() const { return loaded_bytes_; }

    /// The bytes of a buffer, loaded when they are first asked for.
    const std::string& buffer(Index number) {
        const JsonElement element = this->element("buffers", number);
        const Index size = element.at("byteLength").integer(1, max_integer);
        std::string name = binary_chunk_name;
        if (element.has("uri")) {
            name = element.at("uri").text();
        } else {
            require(number == 0 && contents_.count(name) > 0, element.name(),
                    ": has no uri and the file no binary chunk");
        }
        if (contents_.count(name) == 0) {
            std::string content;
            if (name.starts_with("data:")) {
                const std::size_t comma = name.find(";base64,");
                require(comma != std::string::npos &&
                            detail::decode_base64(std::string_view(name).substr(comma + 8), content),
                        element.name(), ".uri: expected data in base64");
            } else {
                const std::string beside = detail::percent_decoded(name);
                require(name.find(':') == std::string::npos && std::filesystem::path(beside).is_relative(),
                        element.name(), ".uri = ", name.substr(0, 80),
                        ", expected data: or the name of a file relative to this one");
                content = read_file(folder_ / beside, element.name());
                loaded_bytes_ += static_cast<Index>(content.size());
            }
            contents_[name] = std::move(content);
        }
        const std::string& content = contents_[name];
        require(size <= static_cast<Index>(content.size()), element.name(), ".byteLength = ", size, ", but there are ",
                content.size(), " bytes");
        return content;
    }

private:
    static bool is_known_extension(const std::string& name) {
        for (const std::string_view known : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"}) {
            if (name.starts_with(known)) {
                return true;
            }
        }
        return name == "KHR_mesh_quantization" || name == "KHR_animation_pointer";
    }

    static std::string read_file(const std::filesystem::path& path, const std::string& name) {
        std::error_code error;  // of names that no file can have
        require(std::filesystem::is_regular_file(path, error), name, ": ", path.string(), " is no file");
        std::ifstream stream(path, std::ios::binary | std::ios::ate);
        require(stream.is_open(), name, ": ", path.string(), " cannot be opened");
        std::string bytes(static_cast<std::size_t>(stream.tellg()), '\0');
        stream.seekg(0);
        stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        require(stream.good(), name, ": ", path.string(), " cannot be read");
        return bytes;
    }

    static std::uint32_t word(const std::string& bytes, std::size_t place) {
        std::uint32_t result = 0;
        for (std::size_t k = 4; k-- > 0;) {
            result = result << 8U | static_cast<unsigned char>(bytes[place + k]);
        }
        return result;
    }

    /// The JSON text of a .glb; its binary chunk becomes the buffer without an address.
    std::string_view read_chunks(const std::string& bytes) {
        constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
        require(bytes.size() >= 20 && word(bytes, 4) == 2, file_, ": is no .glb of version 2");
        require(word(bytes, 8) <= bytes.size() && word(bytes, 8) >= 20, file_, ": has ", bytes.size(),
                " bytes, its header says ", word(bytes, 8));
        const std::size_t end = word(bytes, 8);
        const std::size_t text_size = word(bytes, 12);
        require(word(bytes, 16) == json_chunk && text_size <= end - 20, file_, ": its first chunk (JSON) has ",
                text_size, " bytes, expected at most ", end - 20);
        const std::size_t next = 20 + text_size;
        if (end - next >= 8 && word(bytes, next + 4) == binary_chunk) {
            const std::size_t size = word(bytes, next);
            require(size <= end - next - 8, file_, ": its binary chunk has ", size, " bytes, expected at most ",
                    end - next - 8);
            contents_[binary_chunk_name] = bytes.substr(next + 8, size);
        }
        return std::string_view(bytes).substr(20, text_size);
    }

    inline static const std::string binary_chunk_name;  // the address of no buffer

    std::string file_;
    std::filesystem::path folder_;
    nlohmann::json json_;
    std::map<std::string, std::string> contents_;  // of buffers, by their address
    Index loaded_bytes_ = 0;
};

}  // namespace softtissue
