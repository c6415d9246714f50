// SPDX-License-Identifier: MIT
/// @file
/// The exponential in plain arithmetic: compilers vectorise loops over it.
///
/// What        exp(x + low), low a small correction that x has no digits for
/// Equation    exp(x) = 2^k exp(r),  k = rint(x / ln 2),  |r| <= ln 2 / 2, Taylor polynomial in r
/// Shapes      float and double
/// Valid       every x: overflow gives infinity, underflow is gradual, NaN stays. |low| <= 0.1.
/// Source      argument reduction: Cody, Waite 1980, "Software Manual for the Elementary Functions", ch. 6
/// Cost        20 (float) or 26 (double) additions and products; error below 1.5 ulp
/// Tests       tests/unit/linalg/branchless_exp_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/horner.hpp>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace softtissue {

namespace detail {

/// 2^k of an integer k within the range of the exponent.
template <RealScalar S>
S power_of_two(S k) {
    static_assert(sizeof(S) == 4 || sizeof(S) == 8, "float or double");
    constexpr bool is_float = std::same_as<S, float>;
    using Bits = std::conditional_t<is_float, std::uint32_t, std::uint64_t>;
    constexpr int mantissa = is_float ? 23 : 52;
    constexpr S integers = is_float ? S(0x1.8p23) : S(0x1.8p52);  // here the spacing of numbers is 1
    constexpr Bits bias = is_float ? 127 : 1023;
    return std::bit_cast<S>((std::bit_cast<Bits>(k + integers) + bias) << mantissa);
}

}  // namespace detail

/// exp(x + low).
template <RealScalar S>
S branchless_exp(S x, S low = S(0)) {
    constexpr bool is_float = std::same_as<S, float>;
    // beyond these the result is infinite or zero, and k still fits two exponents
    constexpr S largest = is_float ? S(90) : S(711), smallest = is_float ? S(-105) : S(-750);
    // ln 2 in two parts; k times the first is exact
    constexpr S ln2_high = is_float ? S(0x1.62e4p-1) : S(0x1.62e42fefa3p-1);
    constexpr S ln2_low = is_float ? S(0x1.7f7d1cf79abcap-20) : S(0x1.3de6af278ece6p-42);
    constexpr S inverse_ln2 = S(1.4426950408889634074);
    x = x > largest ? largest : x;
    x = x < smallest ? smallest : x;
    const S k = std::rint(x * inverse_ln2);
    const S r = ((x - k * ln2_high) - k * ln2_low) + low;
    // (exp(r) - 1 - r) / r^2; what follows is below a quarter of an ulp of exp(r)
    S series;
    if constexpr (is_float) {
        series = horner(r, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5);
    } else {
        series = horner(r, 1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320,
                        1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5);
    }
    const S fraction = S(1) + (r + r * r * series);
    const S half = std::rint(S(0.5) * k);
    return fraction * detail::power_of_two(half) * detail::power_of_two(k - half);
}

}  // namespace softtissue
