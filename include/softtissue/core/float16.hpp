// SPDX-License-Identifier: MIT
/// @file
/// Floating-point numbers of 16 bits for storage: IEEE's binary16 and bfloat16.
///
/// What        value() is exact; nearest() rounds to nearest, ties to even. No arithmetic.
/// Equation    value = (-1)^sign 2^(exponent - bias) (1 + mantissa / 2^mantissa_bits), below the normal numbers without the 1
/// Valid       every number: what is too large becomes infinite, NaN stays NaN, -0 stays -0.
/// Source      IEEE 754-2019, sec. 3.4 (binary16); bfloat16 is the upper half of binary32
/// Tests       tests/unit/core/float16_test.cpp
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace softtissue {

template <int mantissa_bits>
struct Float16 {
    static constexpr int top_exponent = (1 << (15 - mantissa_bits)) - 1;  ///< field of infinities and NaN
    static constexpr int min_exponent = 2 - (top_exponent + 1) / 2;       ///< of the smallest normal number
    static constexpr std::uint16_t infinity = top_exponent << mantissa_bits;

    std::uint16_t bits = 0;

    double value() const {
        const int mantissa = bits & ((1 << mantissa_bits) - 1);
        const int exponent = bits >> mantissa_bits & top_exponent;
        double magnitude = std::ldexp(double(mantissa), min_exponent - mantissa_bits);
        if (exponent == top_exponent) {
            using Limits = std::numeric_limits<double>;
            magnitude = mantissa == 0 ? Limits::infinity() : Limits::quiet_NaN();
        } else if (exponent > 0) {
            magnitude =
                std::ldexp(double(mantissa + (1 << mantissa_bits)), min_exponent - mantissa_bits + exponent - 1);
        }
        return (bits & 0x8000) != 0 ? -magnitude : magnitude;
    }

    static Float16 nearest(double value) {
        const int sign = std::signbit(value) ? 0x8000 : 0;
        if (!std::isfinite(value)) {
            const int quiet = std::isnan(value) ? 1 << (mantissa_bits - 1) : 0;
            return {static_cast<std::uint16_t>(sign | infinity | quiet)};
        }
        const int exponent = value == 0.0 ? min_exponent : std::max(std::ilogb(value), min_exponent);
        const double mantissa = std::nearbyint(std::ldexp(std::abs(value), mantissa_bits - exponent));
        // The leading bit of a normal number, and a carry out of the mantissa, count up the exponent's field.
        const double magnitude = std::ldexp(double(exponent - min_exponent), mantissa_bits) + mantissa;
        return {static_cast<std::uint16_t>(sign | static_cast<int>(std::min(magnitude, double(infinity))))};
    }
};

using Half = Float16<10>;
using BFloat16 = Float16<7>;

}  // namespace softtissue
