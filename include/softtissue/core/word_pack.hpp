// SPDX-License-Identifier: MIT
/// @file
/// One SIMD register of 32-bit words, for numbers of fewer bits that lie packed in them.
///
/// What        WordPack: load, mask and shift; its words read as floats, or converted to floats; sums of products of bytes
/// Equation    add_byte_products(u, s): word += sum over j = 0 .. 3 of byte j of u, 0 .. 255, times byte j of s, -128 .. 127
/// Valid       65,536 products of bytes stay within a word. Integers: the same bits whatever the registers.
/// Width       natural_lanes<float> words
/// Needs       no compiler finds the products of bytes by itself: x86 takes them by name, one instruction with VNNI, two
///             products of half-words without; elsewhere plain arithmetic
/// Tests       tests/unit/core/word_pack_test.cpp
#pragma once

#include <softtissue/core/pack.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace softtissue {

namespace detail {

template <int lanes>
struct WordLanes {
    using Words = decltype(Pack<float, lanes>::Mask::lanes);
    static auto to_floats(const Words& words) {
        return __builtin_convertvector(words, typename Pack<float, lanes>::Lanes);
    }
};
template <>
struct WordLanes<1> {
    using Words = std::int32_t;
    static auto to_floats(Words word) { return Pack<float, 1>::Lanes{static_cast<float>(word)}; }
};

/// Bytes 1 and 3 of a word as half-words with their signs.
inline std::int32_t odd_bytes(std::int32_t s) {
    const std::uint32_t low = static_cast<std::uint16_t>(static_cast<std::int16_t>(s) >> 8);
    const std::uint32_t high = static_cast<std::uint32_t>(s >> 24) << 16;
    return static_cast<std::int32_t>(high | low);
}

template <class Words>
[[gnu::always_inline]] inline Words plain_byte_products(const Words& u, std::int32_t s) {
    const auto product = [&](int bit) { return ((u >> bit) & 255) * std::int32_t(static_cast<std::int8_t>(s >> bit)); };
    return product(0) + product(8) + product(16) + product(24);
}

/// By way of products of half-words: products(a, b) adds up those of neighbours.
template <class Words, class Products>
[[gnu::always_inline]] inline Words paired_byte_products(const Words& u, std::int32_t s, const Products& products) {
    const Words none{};
    return products(u & 0x00ff00ff, odd_bytes(s << 8) - none) + products((u >> 8) & 0x00ff00ff, odd_bytes(s) - none);
}

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
template <class Words>
[[gnu::always_inline]] inline Words sum_with_byte_products(const Words& sum, const Words& u, std::int32_t s) {
#if defined(__AVX512VNNI__)
    return std::bit_cast<Words>(
        _mm512_dpbusd_epi32(std::bit_cast<__m512i>(sum), std::bit_cast<__m512i>(u), _mm512_set1_epi32(s)));
#else
    return sum + paired_byte_products(u, s, [](const Words& a, const Words& b) {
               return std::bit_cast<Words>(_mm512_madd_epi16(std::bit_cast<__m512i>(a), std::bit_cast<__m512i>(b)));
           });
#endif
}
#elif defined(__AVX2__) && !(defined(__AVX512F__) && defined(__AVX512DQ__))
template <class Words>
[[gnu::always_inline]] inline Words sum_with_byte_products(const Words& sum, const Words& u, std::int32_t s) {
    return sum + paired_byte_products(u, s, [](const Words& a, const Words& b) {
               return std::bit_cast<Words>(_mm256_madd_epi16(std::bit_cast<__m256i>(a), std::bit_cast<__m256i>(b)));
           });
}
#elif defined(__SSE2__) && !defined(__AVX__)
template <class Words>
[[gnu::always_inline]] inline Words sum_with_byte_products(const Words& sum, const Words& u, std::int32_t s) {
    return sum + paired_byte_products(u, s, [](const Words& a, const Words& b) {
               return std::bit_cast<Words>(_mm_madd_epi16(std::bit_cast<__m128i>(a), std::bit_cast<__m128i>(b)));
           });
}
#else
template <class Words>
[[gnu::always_inline]] inline Words sum_with_byte_products(const Words& sum, const Words& u, std::int32_t s) {
    return sum + plain_byte_products(u, s);
}
#endif

}  // namespace detail

struct WordPack {
    static constexpr int lanes = natural_lanes<float>;
    using Words = typename detail::WordLanes<lanes>::Words;
    using Floats = Pack<float, lanes>;

    Words words;

    [[gnu::always_inline]] static inline WordPack load(const std::uint32_t* from) {
        WordPack result;
        std::memcpy(&result.words, from, sizeof(Words));
        return result;
    }
    [[gnu::always_inline]] static inline WordPack all(std::int32_t word) {
        return {word - Words{}};
    }

    [[gnu::always_inline]] inline WordPack masked(std::uint32_t mask) const {
        return {words & static_cast<std::int32_t>(mask)};
    }
    [[gnu::always_inline]] inline WordPack shifted_left(int bits) const {
        return {words << bits};
    }
    /// Copies of the sign come in from the left: mask what is not wanted.
    [[gnu::always_inline]] inline WordPack shifted_right(int bits) const {
        return {words >> bits};
    }
    friend WordPack operator-(const WordPack& a, const WordPack& b) {
        return {a.words - b.words};
    }

    /// The words as they are stored, read as floats.
    [[gnu::always_inline]] inline Floats as_floats() const {
        Floats result;
        std::memcpy(&result.lanes, &words, sizeof(Words));
        return result;
    }
    /// The integers, rounded to floats.
    [[gnu::always_inline]] inline Floats to_floats() const {
        Floats result;
        result.lanes = detail::WordLanes<lanes>::to_floats(words);
        return result;
    }

    /// See the file comment; the bytes of `s` are the same for all lanes.
    [[gnu::always_inline]] inline void add_byte_products(const WordPack& u, std::int32_t s) {
        words = detail::sum_with_byte_products(words, u.words, s);
    }
};

}  // namespace softtissue
