// SPDX-License-Identifier: MIT
/// @file
/// Numbers from anywhere in memory into the lanes of a pack.
///
/// What        gather<N>(numbers, places): numbers[places[i]] in lane i
/// Cost        one instruction where the machine has it (AVX2, AVX-512), a load for each lane elsewhere
/// Tests       tests/unit/core/pack_gather_test.cpp
#pragma once

#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace softtissue {

template <int N, RealScalar T>
Pack<T, N> gather(const T* numbers, const std::int32_t* places) {
    if constexpr (Pack<T, N>::is_several) {
        constexpr int width = natural_lanes<T>;
        Pack<T, N> result;
        for (std::size_t i = 0; i < result.lanes.size(); ++i) {
            result.lanes[i] = gather<width>(numbers, places + i * std::size_t(width));
        }
        return result;
    }
    // With a mask of ones: gcc takes the unused operand of the plain form for an uninitialised variable.
#if defined(__AVX512F__)
    if constexpr (Pack<T, N>::is_vector && std::same_as<T, float> && N == 16) {
        Pack<T, N> result;
        result.lanes =
            _mm512_mask_i32gather_ps(_mm512_setzero_ps(), __mmask16(-1), _mm512_loadu_si512(places), numbers, 4);
        return result;
    }
    if constexpr (Pack<T, N>::is_vector && std::same_as<T, double> && N == 8) {
        Pack<T, N> result;
        result.lanes = _mm512_mask_i32gather_pd(
            _mm512_setzero_pd(), __mmask8(-1),
            _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(places))), numbers, 8);
        return result;
    }
#endif
#if defined(__AVX2__)
    if constexpr (Pack<T, N>::is_vector && std::same_as<T, float> && N == 8) {
        Pack<T, N> result;
        result.lanes = _mm256_i32gather_ps(
            numbers, _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(places))), 4);
        return result;
    }
    if constexpr (Pack<T, N>::is_vector && std::same_as<T, double> && N == 4) {
        Pack<T, N> result;
        result.lanes = _mm256_i32gather_pd(
            numbers, _mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(places))), 8);
        return result;
    }
#endif
    return Pack<T, N>::from_lanes([&](int i) { return numbers[places[i]]; });
}

}  // namespace softtissue
