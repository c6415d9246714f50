// SPDX-License-Identifier: MIT
/// @file
/// A number that tells contents apart: to recognise data, not to protect against malice.
///
/// What        ByteHash: FNV-1a, 64 bit, over bytes in the order in which they are added
/// Source      Fowler, Noll, Vo 1991
/// Tests       tests/unit/core/byte_hash_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

namespace softtissue {

class ByteHash {
public:
    ByteHash& add(const void* data, std::size_t size) {
        const auto* const bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) {
            add_byte(bytes[i]);
        }
        return *this;
    }

    /// Its four bytes, the lowest first, on every machine.
    ByteHash& add_little_endian(std::uint32_t number) {
        for (int shift = 0; shift < 32; shift += 8) {
            add_byte(static_cast<unsigned char>((number >> shift) & 0xffU));
        }
        return *this;
    }

    std::uint64_t value() const { return value_; }

private:
    void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3U; }

    std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace softtissue
