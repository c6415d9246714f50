// SPDX-License-Identifier: MIT
/// @file
/// Vectors of three numbers from anywhere in memory into the lanes of packs, and back into columns.
///
/// What        gather_columns<N>(numbers, places): numbers[places[i] + k] in lane i of pack k;
///             gather_last_columns(): the same where a column may be the last in memory, one number after the other;
///             store_columns(packs, columns): lane i of pack k to columns[4 i + k]
/// Shapes      three packs; columns of four numbers, the last of which is the third again
/// Reads       gather_columns() reads numbers[places[i] + 3] too
/// Why         a vector is one load and a 4 x 4 transpose within registers: a fifth of the time that gather instructions take
/// Cost        for 16 vectors of floats and registers of 16: 19 (gather) and 8 (store) instructions on registers, besides 16 loads and 4 stores
/// Tests       tests/unit/core/pack_columns_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_shuffle.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace softtissue {

namespace detail {

/// Four numbers each from places[0], places[4], places[8], ...
template <int N, RealScalar T>
[[gnu::always_inline]] inline Pack<T, N> every_fourth_column(const T* numbers, const std::int32_t* places) {
    if constexpr (N == 4) {
        return Pack<T, 4>::load(numbers + places[0]);
    } else {
        return joined(every_fourth_column<N / 2>(numbers, places), every_fourth_column<N / 2>(numbers, places + N / 2));
    }
}

}  // namespace detail

template <int N, RealScalar T>
Vector3<Pack<T, N>> gather_last_columns(const T* numbers, const std::int32_t* places) {
    Vector3<Pack<T, N>> result;
    for (int k = 0; k < 3; ++k) {
        result(k) = Pack<T, N>::from_lanes([&](int i) { return numbers[places[i] + k]; });
    }
    return result;
}

template <int N, RealScalar T>
[[gnu::always_inline]] inline Vector3<Pack<T, N>> gather_columns(const T* numbers, const std::int32_t* places) {
    Vector3<Pack<T, N>> result;
    if constexpr (Pack<T, N>::is_several) {
        constexpr int width = natural_lanes<T>;
        for (std::size_t r = 0; r < std::size_t(N / width); ++r) {
            const Vector3<Pack<T, width>> part = gather_columns<width>(numbers, places + r * std::size_t(width));
            for (int k = 0; k < 3; ++k) {
                result(k).lanes[r] = part(k);
            }
        }
    } else if constexpr (Pack<T, N>::is_vector && N >= 4) {
        const Pack<T, N> a = detail::every_fourth_column<N>(numbers, places),
                         b = detail::every_fourth_column<N>(numbers, places + 1),
                         c = detail::every_fourth_column<N>(numbers, places + 2),
                         d = detail::every_fourth_column<N>(numbers, places + 3);
        // (a0 b0 a2 b2), (a1 b1 a3 b3) of every four; the next shuffle joins the pairs of two of them.
        const auto even = [](int i) { return i % 2 == 0 ? i : N + i - 1; };
        const auto odd = [](int i) { return i % 2 == 0 ? i + 1 : N + i; };
        const auto first_pairs = [](int i) { return i % 4 < 2 ? i : N + i - 2; };
        const auto last_pairs = [](int i) { return i % 4 < 2 ? i + 2 : N + i; };
        const Pack<T, N> ab = shuffled(a, b, even), cd = shuffled(c, d, even);
        result(0) = shuffled(ab, cd, first_pairs);
        result(1) = shuffled(shuffled(a, b, odd), shuffled(c, d, odd), first_pairs);
        result(2) = shuffled(ab, cd, last_pairs);
    } else {
        result = gather_last_columns<N>(numbers, places);
    }
    return result;
}

template <RealScalar T, int N>
[[gnu::always_inline]] inline void store_columns(const Vector3<Pack<T, N>>& packs, T* columns) {
    if constexpr (Pack<T, N>::is_several) {
        constexpr int width = natural_lanes<T>;
        for (std::size_t r = 0; r < std::size_t(N / width); ++r) {
            store_columns<T, width>({packs(0).lanes[r], packs(1).lanes[r], packs(2).lanes[r]},
                                    columns + 4 * width * Index(r));
        }
    } else if constexpr (Pack<T, N>::is_vector && N >= 4) {
        const auto store_quarter = [&]<int q>(std::integral_constant<int, q>) {
            const auto with_second = [](int i) { return q * (N / 4) + i / 4 + (i % 4 == 1 ? N : 0); };
            const auto with_third = [](int i) { return i % 4 < 2 ? i : N + q * (N / 4) + i / 4; };
            shuffled(shuffled(packs(0), packs(1), with_second), packs(2), with_third).store(columns + q * N);
        };
        store_quarter(std::integral_constant<int, 0>());
        store_quarter(std::integral_constant<int, 1>());
        store_quarter(std::integral_constant<int, 2>());
        store_quarter(std::integral_constant<int, 3>());
    } else {
        for (int i = 0; i < N; ++i) {
            for (int k = 0; k < 4; ++k) {
                columns[4 * i + k] = packs(std::min(k, 2))[i];
            }
        }
    }
}

}  // namespace softtissue
