// SPDX-License-Identifier: MIT
/// @file
/// Reciprocals and square roots that need not be rounded correctly: for packs without the divider of the processor.
///
/// What        reciprocal(x) = 1 / x, reciprocal_sqrt(x) = 1 / sqrt(x), quick_sqrt(x) = x / sqrt(x)
/// Equation    y + y (e + e^2 + ...), e = 1 - x y;  y + y e (1/2 + 3/8 e + ...), e = 1 - x y^2, as many terms as count, from an
///             estimate y of 14 bits (AVX-512); elsewhere, and for plain numbers, the quotient
/// Shapes      float and double, one or several side by side
/// Valid       every x; zero, infinity and NaN as by division. quick_sqrt: x >= 0 or NaN.
/// Accuracy    1 ulp, quick_sqrt 2 ulp; a reciprocal below the smallest normal number may be zero
/// Cost        3 (float) or 8 (double) additions and products, where a root and a division keep the divider busy for the time of 40 to 70
/// Tests       tests/unit/core/reciprocal_test.cpp
#pragma once

#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>
#include <concepts>
#include <limits>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace softtissue {

template <RealScalar T>
T reciprocal(T x) {
    return T(1) / x;
}

template <RealScalar T>
T reciprocal_sqrt(T x) {
    return T(1) / std::sqrt(x);
}

template <RealScalar T>
T quick_sqrt(T x) {
    return std::sqrt(x);
}

#if defined(__AVX512F__)
namespace detail {

inline __m512 reciprocal_estimate(__m512 x) {
    return _mm512_maskz_rcp14_ps(__mmask16(-1), x);
}
inline __m512d reciprocal_estimate(__m512d x) {
    return _mm512_maskz_rcp14_pd(__mmask8(-1), x);
}
inline __m512 reciprocal_sqrt_estimate(__m512 x) {
    return _mm512_maskz_rsqrt14_ps(__mmask16(-1), x);
}
inline __m512d reciprocal_sqrt_estimate(__m512d x) {
    return _mm512_maskz_rsqrt14_pd(__mmask8(-1), x);
}

}  // namespace detail
#endif

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> reciprocal(const Pack<T, N>& x) {
    using P = Pack<T, N>;
    if constexpr (P::is_several) {
        return P::map_parts([](const auto& part) { return reciprocal(part); }, x);
    }
    const P one(1);
#if defined(__AVX512F__)
    if constexpr (P::is_vector && sizeof(P) == sizeof(__m512)) {
        P y;
        y.lanes = detail::reciprocal_estimate(x.lanes);
        const P e = one - x * y;
        P rest = e;
        if constexpr (std::same_as<T, double>) {
            const P squared = e * e;
            rest = e + squared + squared * e;
        }
        const P improved = y + y * rest;
        return select(e * e < one, improved, y);  // estimates of zero and infinity are exact, and e is not a number
    }
#endif
    return one / x;
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> reciprocal_sqrt(const Pack<T, N>& x) {
    using P = Pack<T, N>;
    if constexpr (P::is_several) {
        return P::map_parts([](const auto& part) { return reciprocal_sqrt(part); }, x);
    }
    const P one(1);
#if defined(__AVX512F__)
    if constexpr (P::is_vector && sizeof(P) == sizeof(__m512)) {
        const P half(T(0.5));
        P y;
        y.lanes = detail::reciprocal_sqrt_estimate(x.lanes);
        const P e = one - (x * y) * y;
        P rest = half;
        if constexpr (std::same_as<T, double>) {
            rest = (half + e * T(0.375)) + (e * e) * (P(T(0.3125)) + e * T(0.2734375));
        }
        const P improved = y + (y * e) * rest;
        return select(e * e < one, improved, y);
    }
#endif
    return one / sqrt(x);
}

template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> quick_sqrt(const Pack<T, N>& x) {
    if constexpr (Pack<T, N>::is_several) {
        return Pack<T, N>::map_parts([](const auto& part) { return quick_sqrt(part); }, x);
    }
#if defined(__AVX512F__)
    if constexpr (Pack<T, N>::is_vector && sizeof(Pack<T, N>) == sizeof(__m512)) {
        const Pack<T, N> zero(0), infinity(std::numeric_limits<T>::infinity());
        return select((zero < x) & (x < infinity), x * reciprocal_sqrt(x), x);
    }
#endif
    return sqrt(x);
}

}  // namespace softtissue
