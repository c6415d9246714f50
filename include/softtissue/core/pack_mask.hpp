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

}  // namespace detail

/// How many numbers of type T one register of the target holds.
template <RealScalar T>
inline constexpr int natural_lanes = detail::fits_register<T, detail::register_bytes / int(sizeof(T))>
                                         ? detail::register_bytes / int(sizeof(T))
                                         : 1;

template <RealScalar T, int N>
struct Pack;
template <RealScalar T, int N>
struct PackMask;

namespace detail {

template <class T, int N>
inline constexpr bool fills_registers = natural_lanes<T> > 1 && N / natural_lanes<T> > 1 && N % natural_lanes<T> == 0;

/// One register, several, or a number after the other.
template <class T, int N>
struct LaneStorage {
    using Values = std::array<T, std::size_t(N)>;
    using Mask = std::array<bool, std::size_t(N)>;
};

template <class T, int N>
    requires fills_registers<T, N>
struct LaneStorage<T, N> {
    static constexpr int width = natural_lanes<T>;
    using Values = std::array<Pack<T, width>, std::size_t(N / width)>;
    using Mask = std::array<PackMask<T, width>, std::size_t(N / width)>;
};

#if defined(__GNUC__)
template <class T, int N>
    requires fits_register<T, N>
struct LaneStorage<T, N> {
    typedef T Values __attribute__((vector_size(std::size_t(N) * sizeof(T))));
    using Mask = decltype(std::declval<Values>() < std::declval<Values>());
};
#endif

}  // namespace detail

/// N truth values.
template <RealScalar T, int N>
struct PackMask {
    static constexpr bool is_vector = detail::fits_register<T, N>;
    static constexpr bool is_several = detail::fills_registers<T, N>;
    typename detail::LaneStorage<T, N>::Mask lanes;

    bool operator[](int i) const {
        if constexpr (is_several) {
            return lanes[std::size_t(i / natural_lanes<T>)][i % natural_lanes<T>];
        } else {
            return lanes[std::size_t(i)] != 0;
        }
    }

    [[gnu::always_inline]] friend inline PackMask operator&(const PackMask& a, const PackMask& b) {
        return map([](const auto& x, const auto& y) { return x & y; }, a, b);
    }
    [[gnu::always_inline]] friend inline PackMask operator|(const PackMask& a, const PackMask& b) {
        return map([](const auto& x, const auto& y) { return x | y; }, a, b);
    }
    [[gnu::always_inline]] friend inline PackMask operator!(const PackMask& a) {
        return map([](const auto& x) { return x == 0; }, a);
    }

    [[gnu::always_inline]] friend inline bool any_of(const PackMask& a) {
        if constexpr (is_vector) {
            const auto words = std::bit_cast<std::array<std::uint64_t, sizeof(a.lanes) / 8>>(a.lanes);
            std::uint64_t any = 0;
            for (const std::uint64_t word : words) {
                any |= word;
            }
            return any != 0;
        } else if constexpr (is_several) {
            auto any = a.lanes[0];
            for (const auto& part : a.lanes) {
                any = any | part;
            }
            return any_of(any);
        } else {
            bool any = false;
            for (const bool lane : a.lanes) {
                any |= lane;
            }
            return any;
        }
    }
    [[gnu::always_inline]] friend inline bool all_of(const PackMask& a) { return !any_of(!a); }

    /// f of the registers, or of each lane.
    template <class F, class... Operands>
    [[gnu::always_inline]] static inline PackMask map(const F& f, const Operands&... operands) {
        PackMask result;
        if constexpr (is_vector) {
            result.lanes = f(operands.lanes...);
        } else if constexpr (is_several) {
            for (std::size_t i = 0; i < result.lanes.size(); ++i) {
                result.lanes[i] = PackMask<T, natural_lanes<T>>::map(f, operands.lanes[i]...);
            }
        } else {
            for (std::size_t i = 0; i < std::size_t(N); ++i) {
                result.lanes[i] = f(operands.lanes[i]...) != 0;
            }
        }
        return result;
    }
};

}  // namespace softtissue
