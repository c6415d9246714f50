// SPDX-License-Identifier: MIT
/// @file
/// The exponential in plain arithmetic: for packs, and for loops that compilers vectorise.
///
/// What        branchless_exp: exp(x + low), low a small correction that x has no digits for; branchless_expm1: exp(x) - 1
/// Equation    exp(x) = 2^k exp(r),  k = rint(x / ln 2),  |r| <= ln 2 / 2, Taylor polynomial in r
/// Shapes      float and double, one or several side by side
/// Valid       every x: overflow gives infinity, underflow is gradual, NaN stays. |low| <= 0.1.
/// Source      argument reduction: Cody, Waite 1980, "Software Manual for the Elementary Functions", ch. 6
/// Cost        20 (float) or 26 (double) additions and products; errors below 1.5 ulp, of exp(x) - 1 below 2.5 ulp
/// Tests       tests/unit/core/branchless_exp_test.cpp
#pragma once

#include <softtissue/core/horner.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace softtissue {

namespace detail {

template <RealScalar T>
struct FloatBits {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8, "float or double");
    static constexpr bool is_float = std::same_as<T, float>;
    using Word = std::conditional_t<is_float, std::uint32_t, std::uint64_t>;
    static constexpr int mantissa = is_float ? 23 : 52;
    static constexpr Word bias = is_float ? 127 : 1023;
    /// Here the spacing of numbers is 1.
    static constexpr T integers = is_float ? T(0x1.8p23) : T(0x1.8p52);
};

/// 2^k of an integer k within the range of the exponent.
template <RealScalar T>
T power_of_two(T k) {
    using Bits = FloatBits<T>;
    using Word = typename Bits::Word;
    return std::bit_cast<T>((std::bit_cast<Word>(k + Bits::integers) + Bits::bias) << Bits::mantissa);
}

template <class T, int N>
Pack<T, N> power_of_two(const Pack<T, N>& k) {
    if constexpr (Pack<T, N>::is_vector) {
        using Bits = FloatBits<T>;
        using Words = decltype(Pack<T, N>::Mask::lanes);
        Pack<T, N> result;
        const Words biased = std::bit_cast<Words>((k + Pack<T, N>(Bits::integers)).lanes) +
                             static_cast<std::make_signed_t<typename Bits::Word>>(Bits::bias);
        result.lanes = std::bit_cast<typename Pack<T, N>::Lanes>(biased << Bits::mantissa);
        return result;
    } else {
        return Pack<T, N>::map_parts([](const auto& a) { return power_of_two(a); }, k);
    }
}

/// exp(x) = 2^half 2^(k - half) (1 + below_one): two powers, for k may be beyond the exponents.
template <RealLanes S>
struct SplitExponential {
    S below_one, half, rest;

    explicit SplitExponential(S x, S low = S(0)) {
        using T = RealOf<S>;
        constexpr bool is_float = std::same_as<T, float>;
        // beyond these the result is infinite or zero, and k still fits two exponents
        constexpr T largest = is_float ? T(90) : T(711), smallest = is_float ? T(-105) : T(-750);
        // ln 2 in two parts; k times the first is exact
        constexpr T ln2_high = is_float ? T(0x1.62e4p-1) : T(0x1.62e42fefa3p-1);
        constexpr T ln2_low = is_float ? T(0x1.7f7d1cf79abcap-20) : T(0x1.3de6af278ece6p-42);
        x = select(x > S(largest), S(largest), x);
        x = select(x < S(smallest), S(smallest), x);
        const S k = nearest_integer(S(x * T(1.4426950408889634074)));
        const S r = S(S(x - k * ln2_high) - k * ln2_low) + low;
        // (exp(r) - 1 - r) / r^2; what follows is below a quarter of an ulp of exp(r)
        S series;
        if constexpr (is_float) {
            series = horner(r, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5);
        } else {
            series = horner(r, 1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880,
                            1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5);
        }
        below_one = r + r * r * series;
        half = nearest_integer(S(T(0.5) * k));
        rest = k - half;
    }

private:
    static S nearest_integer(const S& x) {
        const S integers = S(FloatBits<RealOf<S>>::integers);
        return (x + integers) - integers;
    }
};

}  // namespace detail

/// exp(x + low).
template <RealLanes S>
S branchless_exp(S x, S low = S(0)) {
    const detail::SplitExponential<S> e(x, low);
    return (S(1) + e.below_one) * detail::power_of_two(e.half) * detail::power_of_two(e.rest);
}

/// exp(x) - 1, keeping the digits of small x.
template <RealLanes S>
S branchless_expm1(S x) {
    const detail::SplitExponential<S> e(x);
    const S first = detail::power_of_two(e.half);
    return (e.below_one * first + (first - detail::power_of_two(S(-e.rest)))) * detail::power_of_two(e.rest);
}

}  // namespace softtissue
