// SPDX-License-Identifier: MIT
/// @file
/// The header of a .npy array: element type, shape and order.
///
/// What        parses format versions 1 to 3 and writes version 1.
/// Refuses     a wrong magic string, a header that is cut off or malformed, a shape whose size is not that of the data
///             (InvalidInput names file and array). Element types that hold no plain numbers or text (pickled objects,
///             records, half, complex, dates) are described in `unsupported` and refused on access, so that one such array
///             does not make the others of a file unreadable.
/// Source      numpy, "NEP 1: A simple file format for NumPy arrays"
/// Tests       tests/unit/io/npy_header_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softtissue {

/// Element type: kind 'f' real, 'i' signed, 'u' unsigned, 'b' boolean, 'U' UTF-32 text, 'S' bytes of text.
struct NpyType {
    char kind = 'f';
    std::size_t size = 8;  ///< bytes per element
    bool swapped = false;  ///< stored in the byte order that is not this machine's

    bool operator==(const NpyType&) const = default;
};

struct NpyHeader {
    NpyType type;
    bool fortran_order = false;
    std::vector<Index> shape;
    std::size_t data_offset = 0;  ///< where the elements begin in the file
    std::string unsupported;      ///< why the elements cannot be read; empty if they can
};

namespace detail {

/// Reads the header's Python dictionary, a literal of three known keys.
class NpyDictionary {
public:
    NpyDictionary(const std::string& source, std::string_view text) : source_(source), text_(text) {}

    void parse_into(NpyHeader& header) {
        bool has_descr = false;
        bool has_order = false;
        bool has_shape = false;
        expect('{');
        while (!accept('}')) {
            const std::string_view key = quoted();
            expect(':');
            bool* const seen = key == "descr"           ? &has_descr
                               : key == "fortran_order" ? &has_order
                               : key == "shape"         ? &has_shape
                                                        : nullptr;
            require(seen != nullptr && !*seen, source_, ": npy header has the key '", key,
                    "', expected descr, fortran_order and shape once each");
            *seen = true;
            if (key == "descr") {
                parse_descr(header);
            } else if (key == "fortran_order") {
                header.fortran_order = parse_bool();
            } else {
                header.shape = parse_shape();
            }
            if (!accept(',')) {
                expect('}');
                break;
            }
        }
        skip_space();
        require(position_ == text_.size() && has_descr && has_order && has_shape, source_,
                ": npy header is malformed, expected a dictionary of descr, fortran_order and shape");
    }

private:
    void skip_space() {
        while (position_ < text_.size() && (text_[position_] == ' ' || text_[position_] == '\n')) {
            ++position_;
        }
    }
    bool accept(char c) {
        skip_space();
        if (position_ < text_.size() && text_[position_] == c) {
            ++position_;
            return true;
        }
        return false;
    }
    void expect(char c) {
        require(accept(c), source_, ": npy header is malformed, expected '", c, "' at its character ", position_);
    }
    std::string_view quoted() {
        const char quote = accept('"') ? '"' : '\'';
        if (quote == '\'') {
            expect('\'');
        }
        const std::size_t end = text_.find(quote, position_);
        require(end != std::string_view::npos, source_, ": npy header is malformed, expected a closing quote");
        const std::string_view word = text_.substr(position_, end - position_);
        position_ = end + 1;
        return word;
    }
    bool parse_bool() {
        skip_space();
        const std::string_view rest = text_.substr(position_);
        const bool value = rest.starts_with("True");
        require(value || rest.starts_with("False"), source_, ": fortran_order is neither True nor False");
        position_ += value ? 4 : 5;
        return value;
    }
    std::vector<Index> parse_shape() {
        std::vector<Index> shape;
        expect('(');
        while (!accept(')')) {
            shape.push_back(parse_extent());
            if (!accept(',')) {
                expect(')');
                break;
            }
        }
        return shape;
    }
    Index parse_extent() {
        skip_space();
        const std::size_t first = position_;
        Index extent = 0;
        while (position_ < text_.size() && text_[position_] >= '0' && text_[position_] <= '9') {
            const Index digit = text_[position_++] - '0';
            require(extent <= (std::numeric_limits<Index>::max() - digit) / 10, source_, ": shape is too large");
            extent = 10 * extent + digit;
        }
        require(position_ > first, source_, ": shape is malformed, expected whole numbers >= 0");
        if (position_ < text_.size() && text_[position_] == 'L') {
            ++position_;  // a long integer as Python 2 wrote it
        }
        return extent;
    }

    void parse_descr(NpyHeader& header) {
        skip_space();
        if (position_ < text_.size() && text_[position_] == '[') {
            header.unsupported = "its elements are records";
            skip_list();
            return;
        }
        const std::string_view descr = quoted();
        header.unsupported = "its element type is '" + std::string(descr) + "'";
        if (descr == "|O" || descr == "O") {
            header.unsupported = "it holds pickled Python objects, which are programs rather than data";
            return;
        }
        if (descr.size() < 3 || descr.size() > 12 ||
            std::string_view("<>|=").find(descr[0]) == std::string_view::npos) {
            return;
        }
        std::size_t size = 0;
        for (const char c : descr.substr(2)) {
            if (c < '0' || c > '9') {
                return;
            }
            size = 10 * size + std::size_t(c - '0');
        }
        constexpr char foreign = std::endian::native == std::endian::little ? '>' : '<';
        const char kind = descr[1];
        header.type = {kind, kind == 'U' ? 4 * size : size, descr[0] == foreign};
        const bool known = ((kind == 'i' || kind == 'u') && (size == 1 || size == 2 || size == 4 || size == 8)) ||
                           (kind == 'f' && (size == 4 || size == 8)) || (kind == 'b' && size == 1) ||
                           ((kind == 'U' || kind == 'S') && size > 0);
        if (known) {
            header.unsupported.clear();
        }
    }
    void skip_list() {
        int depth = 0;
        while (position_ < text_.size()) {
            const char c = text_[position_++];
            depth += c == '[' ? 1 : c == ']' ? -1 : 0;
            if (depth == 0) {
                return;
            }
        }
    }

    const std::string& source_;
    std::string_view text_;
    std::size_t position_ = 0;
};

}  // namespace detail

/// The number of elements of `shape`; a shape whose count overflows throws.
inline Index count_npy_elements(const std::string& source, const std::vector<Index>& shape) {
    Index count = 1;
    for (const Index extent : shape) {
        require(extent == 0 || count <= std::numeric_limits<Index>::max() / extent, source, ": shape is too large");
        count *= extent;
    }
    return count;
}

/// Parses and checks the header of the .npy file `bytes`; `source` (file and array) starts the message.
inline NpyHeader parse_npy_header(const std::string& source, std::span<const unsigned char> bytes) {
    constexpr std::string_view magic = "\x93NUMPY";
    bool is_npy = bytes.size() >= 10;
    for (std::size_t i = 0; is_npy && i < magic.size(); ++i) {
        is_npy = bytes[i] == static_cast<unsigned char>(magic[i]);
    }
    require(is_npy, source, ": not a .npy array, expected it to begin with \\x93NUMPY");
    const int version = bytes[6];
    require(version >= 1 && version <= 3, source, ": npy format version ", version, ", expected 1, 2 or 3");
    const std::size_t length_bytes = version == 1 ? 2 : 4;
    const std::size_t dictionary = 8 + length_bytes;
    require(bytes.size() >= dictionary, source, ": npy header is cut off");
    std::size_t length = 0;
    for (std::size_t i = length_bytes; i-- > 0;) {
        length = 256 * length + bytes[8 + i];
    }
    require(length <= bytes.size() - dictionary, source, ": npy header claims ", length, " bytes, the array has ",
            bytes.size() - dictionary);

    NpyHeader header;
    const std::string text(bytes.begin() + std::ptrdiff_t(dictionary),
                           bytes.begin() + std::ptrdiff_t(dictionary + length));
    detail::NpyDictionary(source, text).parse_into(header);
    header.data_offset = dictionary + length;
    constexpr std::size_t most_dimensions = 64;  // of numpy
    require(header.shape.size() <= most_dimensions, source, ": has ", header.shape.size(),
            " dimensions, expected at most ", most_dimensions);
    const auto count = static_cast<std::size_t>(count_npy_elements(source, header.shape));
    const std::size_t available = bytes.size() - header.data_offset;
    if (header.unsupported.empty()) {
        const std::size_t size = header.type.size;
        require(count <= available / size && count * size == available, source, ": has ", available,
                " bytes of data, expected ", count, " elements of ", size, " bytes for its shape");
    }
    return header;
}

/// The header of a .npy file in this machine's byte order; type, order and shape are taken from `header`.
inline std::string make_npy_header(const NpyHeader& header) {
    const NpyType& type = header.type;
    const char order = type.size == 1 || type.kind == 'S'           ? '|'
                       : std::endian::native == std::endian::little ? '<'
                                                                    : '>';
    std::string shape;
    for (const Index extent : header.shape) {
        shape += std::to_string(extent) + (header.shape.size() == 1 ? "," : ", ");
    }
    if (header.shape.size() > 1) {
        shape.resize(shape.size() - 2);
    }
    std::string dictionary =
        std::string("{'descr': '") + order + type.kind + std::to_string(type.kind == 'U' ? type.size / 4 : type.size) +
        "', 'fortran_order': " + (header.fortran_order ? "True" : "False") + ", 'shape': (" + shape + "), }";
    constexpr std::size_t alignment = 64;
    constexpr std::size_t preamble = 10;
    const std::size_t unpadded = preamble + dictionary.size() + 1;
    dictionary.append((alignment - unpadded % alignment) % alignment, ' ');
    dictionary += '\n';
    require(dictionary.size() <= 0xFFFF, "npy header: ", header.shape.size(), " dimensions, expected at most 64");
    std::string text("\x93NUMPY\x01\x00", 8);
    text += static_cast<char>(dictionary.size() & 0xFF);
    text += static_cast<char>(dictionary.size() >> 8);
    return text + dictionary;
}

}  // namespace softtissue
