// SPDX-License-Identifier: MIT
/// @file
/// Numbers as text for a page: differences, byte planes, zlib, base64; examples/report/src/unpack.js is the reverse.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace examples {

/// Of a signed difference: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
template <class Unsigned>
Unsigned folded(Unsigned difference) {
    constexpr int bits = 8 * int(sizeof(Unsigned));
    const bool is_negative = (difference >> (bits - 1)) != 0;
    return static_cast<Unsigned>((difference << 1) ^ (is_negative ? ~Unsigned(0) : Unsigned(0)));
}

/// Lowest bytes of all numbers first.
template <class Unsigned>
std::vector<unsigned char> planes(const std::vector<Unsigned>& numbers) {
    std::vector<unsigned char> bytes;
    bytes.reserve(numbers.size() * sizeof(Unsigned));
    for (size_t plane = 0; plane < sizeof(Unsigned); ++plane) {
        for (const Unsigned number : numbers) {
            bytes.push_back(static_cast<unsigned char>((number >> (8 * plane)) & 0xFFU));
        }
    }
    return bytes;
}

inline std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(4 * (bytes.size() / 3 + 1));
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < count ? bytes[i + k] : 0U);
        }
        for (size_t k = 0; k < 4; ++k) {
            text += k <= count ? digits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

template <class Unsigned>
std::string packed(const std::vector<Unsigned>& numbers) {
    const std::vector<unsigned char> bytes = planes(numbers);
    uLongf size = compressBound(uLong(bytes.size()));
    std::vector<unsigned char> result(size);
    const int status = compress2(result.data(), &size, bytes.data(), uLong(bytes.size()), 6);
    softtissue::require(status == Z_OK, "report: zlib's status ", status);
    result.resize(size);
    return base64(result);
}

inline std::string packed_indices(const std::int32_t* indices, softtissue::Index count) {
    std::vector<std::uint32_t> codes;
    std::uint32_t before = 0;
    for (softtissue::Index i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(indices[i]);
        codes.push_back(folded<std::uint32_t>(index - before));
        before = index;
    }
    return packed(codes);
}

/// `rows` of equal length, each as differences from the row `stride` before, and from number to number.
template <class Unsigned>
std::string packed_rows(const std::vector<std::vector<Unsigned>>& rows, size_t stride) {
    std::vector<Unsigned> codes;
    for (size_t r = 0; r < rows.size(); ++r) {
        Unsigned before = 0;
        for (size_t i = 0; i < rows[r].size(); ++i) {
            const Unsigned change = static_cast<Unsigned>(rows[r][i] - (r >= stride ? rows[r - stride][i] : 0));
            codes.push_back(folded<Unsigned>(static_cast<Unsigned>(change - before)));
            before = change;
        }
    }
    return packed(codes);
}

}  // namespace examples
