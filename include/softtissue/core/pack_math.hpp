// SPDX-License-Identifier: MIT
/// @file
/// Elementary functions of packs, found beside those of std by `using std::sqrt; sqrt(x)`.
///
/// What        abs, copysign, min, max, sqrt; exp, expm1
/// Equation    lane by lane what std gives for a plain number, NaN and signed zeros as there: bit for bit, exp and expm1 within
///             a unit of the last digit or two (branchless_exp.hpp)
/// Cost        abs, copysign, min, max one instruction or two, sqrt one; exp and expm1 about thirty
/// Needs       a compiler option cannot make a loop of std::sqrt one instruction (errno): x86 takes the instruction by name
/// Tests       tests/unit/core/pack_math_test.cpp
#pragma once

#include <softtissue/core/branchless_exp.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace softtissue {

namespace detail {

#if defined(__SSE2__)
inline __m128 register_sqrt(__m128 x) {
    return _mm_sqrt_ps(x);
}
inline __m128d register_sqrt(__m128d x) {
    return _mm_sqrt_pd(x);
}
#endif
#if defined(__AVX__)
inline __m256 register_sqrt(__m256 x) {
    return _mm256_sqrt_ps(x);
}
inline __m256d register_sqrt(__m256d x) {
    return _mm256_sqrt_pd(x);
}
#endif
#if defined(__AVX512F__)
// With a mask of ones: gcc takes the unused operand of the plain form for an uninitialised variable.
inline __m512 register_sqrt(__m512 x) {
    return _mm512_maskz_sqrt_ps(__mmask16(-1), x);
}
inline __m512d register_sqrt(__m512d x) {
    return _mm512_maskz_sqrt_pd(__mmask8(-1), x);
}
#endif

/// The sign bits of `signs` on the magnitudes of x.
template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> with_sign_bits(const Pack<T, N>& x, const Pack<T, N>& signs, bool is_kept) {
    using Words = decltype(Pack<T, N>::Mask::lanes);
    const auto sign = std::bit_cast<Words>(Pack<T, N>(T(-0.0)).lanes);
    const auto magnitude = std::bit_cast<Words>(x.lanes) & ~sign;
    Pack<T, N> result;
    result.lanes = std::bit_cast<typename Pack<T, N>::Lanes>(
        is_kept ? magnitude | (std::bit_cast<Words>(signs.lanes) & sign) : magnitude);
    return result;
}

}  // namespace detail

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> abs(const Pack<T, N>& x) {
    using std::abs;
    if constexpr (Pack<T, N>::is_vector) {
        return detail::with_sign_bits(x, x, false);
    } else {
        return Pack<T, N>::map_parts([](const auto& a) { return abs(a); }, x);
    }
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> copysign(const Pack<T, N>& x, const Pack<T, N>& sign) {
    using std::copysign;
    if constexpr (Pack<T, N>::is_vector) {
        return detail::with_sign_bits(x, sign, true);
    } else {
        return Pack<T, N>::map_parts([](const auto& a, const auto& b) { return copysign(a, b); }, x, sign);
    }
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> min(const Pack<T, N>& a, const Pack<T, N>& b) {
    return select(b < a, b, a);
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> max(const Pack<T, N>& a, const Pack<T, N>& b) {
    return select(a < b, b, a);
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> sqrt(const Pack<T, N>& x) {
    using std::sqrt;
#if defined(__SSE2__)
    if constexpr (Pack<T, N>::is_vector && sizeof(Pack<T, N>) >= 16) {
        Pack<T, N> result;
        result.lanes = detail::register_sqrt(x.lanes);
        return result;
    }
#endif
    if constexpr (Pack<T, N>::is_vector) {
        return Pack<T, N>::map_lanes([](T a) { return std::sqrt(a); }, x);
    } else {
        return Pack<T, N>::map_parts([](const auto& a) { return sqrt(a); }, x);
    }
}

template <class T, int N>
Pack<T, N> exp(const Pack<T, N>& x) {
    return branchless_exp(x);
}

template <class T, int N>
Pack<T, N> expm1(const Pack<T, N>& x) {
    return copysign(branchless_expm1(x), x);
}

}  // namespace softtissue
