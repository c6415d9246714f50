// SPDX-License-Identifier: MIT
/// @file
/// The normal distribution in plain arithmetic: compilers vectorise loops over it.
///
/// What        its cumulative distribution and its density, together, since one exponential serves both
/// Equation    Phi(x) = erfc(-x / sqrt 2) / 2,  phi(x) = exp(-x^2 / 2) / sqrt(2 pi);
///             Phi(-t) = exp(-t^2 / 2) w p(v),  w = 1 / (t + k),  v the linear function of w that maps t = 0 .. T to -1 .. 1,
///             p a polynomial;  Phi(t) = 1 - Phi(-t)
/// Shapes      float and double
/// Valid       every x; NaN gives cumulative 0, so multiply by x. Both keep their relative accuracy in the lower tail,
///             down to gradual underflow.
/// Source      the mapping: Shepherd, Laframboise 1981, "Chebyshev Approximation of (1 + 2x) exp(x^2) erfc x in 0 <= x < oo";
///             the coefficients: Chebyshev interpolation in 40 digits (error 1.2e-9 in float, 1.2e-17 in double)
/// Cost        one exponential, one division, 11 (float) or 23 (double) products; error below 4 ulp
/// Tests       tests/unit/nn/normal_distribution_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>
#include <softtissue/core/branchless_exp.hpp>
#include <softtissue/core/horner.hpp>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>

namespace softtissue {

/// Phi(x) and phi(x).
template <class S>
struct NormalDistribution {
    S cumulative;
    S density;
};

namespace detail {

/// exp(-t^2 / 2) without the rounding of t^2: t is cut to half its digits, whose square is exact.
template <class S>
S half_square_exp(S t) {
    S cut;
    if constexpr (std::same_as<S, float>) {
        cut = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) & 0xfffff000U);
    } else {
        cut = std::bit_cast<double>(std::bit_cast<std::uint64_t>(t) & 0xfffffffff8000000U);
    }
    return branchless_exp(S(-0.5) * cut * cut, S(-0.5) * (t - cut) * (t + cut));
}

/// Phi(-t) / exp(-t^2 / 2) for 0 <= t <= largest_deviation.
template <class S>
S scaled_lower_tail(S t) {
    if constexpr (std::same_as<S, float>) {
        const S w = S(1) / (t + S(3));
        return w * horner((S(1.375) * t - S(3)) * w, 9.9801134685444407073e-6, 9.7130615532190095442e-6,
                          -9.4138060500748485353e-5, -1.8973218258081655847e-4, 6.9899981128585964526e-4,
                          0.0023380389539511458669, -0.0077702815987761819758, -0.0233010212737258214,
                          0.17769485364462687621, -0.49289966429958649489, 0.81541792193145146823);
    } else {
        const S w = S(1) / (t + S(5));
        return w * horner((S(1.25) * t - S(5)) * w, -1.3541907749555957386e-11, 1.7962184769349554554e-10,
                          3.0446083584414694999e-10, -2.285383069074705766e-9, -3.8216936943128150028e-9,
                          1.9458947733644452592e-8, 3.7413919763276517308e-8, -1.6561075724716560169e-7,
                          -3.1422974001250009733e-7, 1.6315859586787983092e-6, 1.9814501492432972472e-6,
                          -1.8309490479282254114e-5, 4.0269212343288507805e-6, 1.9836149533099784178e-4,
                          -5.3135214140072298758e-4, -8.9223599831150024338e-4, 0.011238259242247341778,
                          -0.046439848471167912351, 0.12948165075059558231, -0.27811948195866782156,
                          0.484374984142828287, -0.70046492716831294521, 0.84969577171772043004);
    }
}

}  // namespace detail

template <RealScalar S>
NormalDistribution<S> normal_distribution(S x) {
    constexpr S largest_deviation = std::same_as<S, float> ? S(16) : S(40);  // beyond it both are zero
    constexpr S inverse_sqrt_two_pi = S(0.39894228040143267794);
    const S distance = std::abs(x);
    const S t = distance < largest_deviation ? distance : largest_deviation;
    const S e = detail::half_square_exp(t);
    const S tail = e * detail::scaled_lower_tail(t);
    return {x > S(0) ? S(1) - tail : tail, e * inverse_sqrt_two_pi};
}

}  // namespace softtissue
