// SPDX-License-Identifier: MIT
/// @file
/// A polynomial whose coefficients are written out: no loop, hence nothing that keeps a loop around it from vectorising.
///
/// What        horner(x, c_n, ..., c_1, c_0), the highest power first
/// Equation    (...(c_n x + c_{n-1}) x + ...) x + c_0
/// Shapes      any scalar; coefficients are double, rounded to the scalar
/// Tests       tests/unit/core/horner_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <concepts>

namespace softtissue {

template <FieldScalar S, std::same_as<double>... Coefficients>
constexpr S horner(const S& x, double highest, Coefficients... lower) {
    S value = S(static_cast<RealOf<S>>(highest));
    ((value = value * x + S(static_cast<RealOf<S>>(lower))), ...);
    return value;
}

}  // namespace softtissue
