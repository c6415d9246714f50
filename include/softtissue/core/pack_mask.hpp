// SPDX-License-Identifier: MIT
/// @file
/// How many numbers one SIMD register holds, and the truth values of comparing that many at once.
///
/// What        natural_lanes<T>; PackMask<T, N>: `&`, `|`, `!`, any_of(), all_of() of N truth values
/// Width       natural_lanes<T> of the target: 16 floats or 8 doubles with AVX-512, 8 or 4 with AVX, 4 or 2 with SSE2 and NEON,
///             one otherwise. No flag is exported: compile with -march=native (or the like) for the machine that runs the
///             program, all of the program alike.
/// Needs       the vector extensions of gcc and clang for speed; arrays elsewhere
/// Tests       tests/unit/core/pack_mask_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace softtissue {

namespace detail {

#if !defined(__GNUC__)
inline constexpr int register_bytes = 0;
#elif defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int register_bytes = 32;
#elif defined(__SSE2__) || defined(__ARM_NEON)
inline constexpr int register_bytes = 16;
#else
inline constexpr int register_bytes = 0;
#endif

template <class T, int N>
inline constexpr bool fits_register = N > 1 && (N & (N - 1)) == 0 && N* int(sizeof(T)) <= register_bytes &&
                                      (std::same_as<T, float> || std::same_as<T, double>);

template <class T, int N, bool is_vector>
struct LaneStorage {
    using Values = std::array<T, std::size_t(N)>;
    using Mask = std::array<bool, std::size_t(N)>;
};

#if defined(__GNUC__)
template <class T, int N>
struct LaneStorage<T, N, true> {
    typedef T Values __attribute__((vector_size(std::size_t(N) * sizeof(T))));
    using Mask = decltype(std::declval<Values>() < std::declval<Values>());
};
#endif

}  // namespace detail

/// How many numbers of type T one register of the target holds.
template <RealScalar T>
inline constexpr int natural_lanes = detail::fits_register<T, detail::register_bytes / int(sizeof(T))>
                                         ? detail::register_bytes / int(sizeof(T))
                                         : 1;

/// N truth values.
template <RealScalar T, int N>
struct PackMask {
    static constexpr bool is_vector = detail::fits_register<T, N>;
    typename detail::LaneStorage<T, N, is_vector>::Mask lanes;

    bool operator[](int i) const { return lanes[std::size_t(i)] != 0; }

    friend PackMask operator&(const PackMask& a, const PackMask& b) {
        return map([](const auto& x, const auto& y) { return x & y; }, a, b);
    }
    friend PackMask operator|(const PackMask& a, const PackMask& b) {
        return map([](const auto& x, const auto& y) { return x | y; }, a, b);
    }
    friend PackMask operator!(const PackMask& a) {
        return map([](const auto& x) { return x == 0; }, a);
    }

    friend bool any_of(const PackMask& a) {
        if constexpr (is_vector) {
            const auto words = std::bit_cast<std::array<std::uint64_t, sizeof(a.lanes) / 8>>(a.lanes);
            std::uint64_t any = 0;
            for (const std::uint64_t word : words) {
                any |= word;
            }
            return any != 0;
        } else {
            bool any = false;
            for (const bool lane : a.lanes) {
                any |= lane;
            }
            return any;
        }
    }
    friend bool all_of(const PackMask& a) { return !any_of(!a); }

    /// f of the registers, or of each lane.
    template <class F, class... Operands>
    [[gnu::always_inline]] static inline PackMask map(const F& f, const Operands&... operands) {
        PackMask result;
        if constexpr (is_vector) {
            result.lanes = f(operands.lanes...);
        } else {
            for (std::size_t i = 0; i < std::size_t(N); ++i) {
                result.lanes[i] = f(operands.lanes[i]...) != 0;
            }
        }
        return result;
    }
};

}  // namespace softtissue
