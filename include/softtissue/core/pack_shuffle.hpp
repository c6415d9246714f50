// SPDX-License-Identifier: MIT
/// @file
/// Lanes of packs in another order.
///
/// What        joined(a, b): the lanes of a, then those of b;  chosen<i...>(a): lanes i... of a, as many as there are;
///             shuffled(a, b, lane_of): lane i is number lane_of(i) of joined(a, b)
/// Cost        an instruction each where the packs fit a register
/// Tests       tests/unit/core/pack_shuffle_test.cpp
#pragma once

#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace softtissue {

namespace detail {

template <class T, int N, std::size_t... i>
[[gnu::always_inline]] inline Pack<T, 2 * N> joined(const Pack<T, N>& a, const Pack<T, N>& b,
                                                    std::index_sequence<i...>) {
    Pack<T, 2 * N> result;
    result.lanes = __builtin_shufflevector(a.lanes, b.lanes, int(i)...);
    return result;
}

template <class T, int N, class LaneOf, std::size_t... i>
[[gnu::always_inline]] inline Pack<T, N> shuffled(const Pack<T, N>& a, const Pack<T, N>& b, std::index_sequence<i...>) {
    Pack<T, N> result;
    result.lanes = __builtin_shufflevector(a.lanes, b.lanes, LaneOf{}(int(i))...);
    return result;
}

}  // namespace detail

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, 2 * N> joined(const Pack<T, N>& a, const Pack<T, N>& b) {
    if constexpr (Pack<T, 2 * N>::is_vector && Pack<T, N>::is_vector) {
        return detail::joined(a, b, std::make_index_sequence<std::size_t(2 * N)>());
    } else {
        return Pack<T, 2 * N>::from_lanes([&](int i) { return i < N ? a[i] : b[i - N]; });
    }
}

template <int... indices, class T, int N>
[[gnu::always_inline]] inline Pack<T, int(sizeof...(indices))> chosen(const Pack<T, N>& a) {
    static_assert(((indices >= 0 && indices < N) && ...), "a pack has lanes 0 to N - 1");
    using Result = Pack<T, int(sizeof...(indices))>;
    if constexpr (Pack<T, N>::is_vector && Result::is_vector) {
        Result result;
        result.lanes = __builtin_shufflevector(a.lanes, a.lanes, indices...);
        return result;
    } else {
        constexpr std::array<int, sizeof...(indices)> places{indices...};
        return Result::from_lanes([&](int i) { return a[places[std::size_t(i)]]; });
    }
}

/// `lane_of` is a lambda without captures.
template <class T, int N, class LaneOf>
[[gnu::always_inline]] inline Pack<T, N> shuffled(const Pack<T, N>& a, const Pack<T, N>& b, const LaneOf& lane_of) {
    if constexpr (Pack<T, N>::is_vector) {
        return detail::shuffled<T, N, LaneOf>(a, b, std::make_index_sequence<std::size_t(N)>());
    } else {
        return Pack<T, N>::from_lanes([&](int i) { return lane_of(i) < N ? a[lane_of(i)] : b[lane_of(i) - N]; });
    }
}

}  // namespace softtissue
