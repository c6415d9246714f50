// SPDX-License-Identifier: MIT
/// @file
/// The Gaussian error linear unit, exact and in its tanh form: two different functions.
///
/// What        Gelu, TanhGelu: value and derivative of an activation
/// Equation    Gelu: x Phi(x);   TanhGelu: x (1 + tanh a) / 2 = x / (1 + exp(-2a)),  a = sqrt(2 / pi) (x + 0.044715 x^3)
/// Shapes      float and double
/// Valid       finite x. Negative x keep their relative accuracy, which 1 + erf would lose.
/// Source      Hendrycks, Gimpel 2016, "Gaussian Error Linear Units"
/// Departs     nothing; PyTorch's GELU() is Gelu, its GELU('tanh') is TanhGelu; they differ by up to 5e-4
/// Cost        one exponential and one division; loops over either are vectorised
/// Tests       tests/unit/nn/gelu_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>
#include <softtissue/core/branchless_exp.hpp>
#include <softtissue/nn/concepts.hpp>
#include <softtissue/nn/normal_distribution.hpp>

namespace softtissue {

/// x Phi(x).
struct Gelu {
    template <RealScalar S>
    static ActivationValue<S> at(S x) {
        const NormalDistribution<S> normal = normal_distribution(x);
        return {x * normal.cumulative, normal.cumulative + x * normal.density};
    }
};

/// The approximation of Gelu by a hyperbolic tangent.
struct TanhGelu {
    template <RealScalar S>
    static ActivationValue<S> at(S x) {
        constexpr S two_sqrt_two_over_pi = S(1.5957691216057307117), cubic = S(0.044715);
        constexpr S saturated = S(100);  // what follows no longer changes, and its powers are finite
        const S bounded = x > saturated ? saturated : x < -saturated ? -saturated : x;
        const S square = bounded * bounded;
        const S exponent = -two_sqrt_two_over_pi * bounded * (S(1) + cubic * square);
        const S slope = two_sqrt_two_over_pi * (S(1) + S(3) * cubic * square);
        const S e = branchless_exp(exponent < largest_exponent<S> ? exponent : largest_exponent<S>);
        const S sigmoid = S(1) / (S(1) + e);
        return {x * sigmoid, sigmoid + bounded * (sigmoid * (e * sigmoid)) * slope};
    }

private:
    template <RealScalar S>
    static constexpr S largest_exponent = sizeof(S) == 4 ? S(87) : S(708);  // its exponential is finite
};

}  // namespace softtissue
