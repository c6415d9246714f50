// SPDX-License-Identifier: MIT
/// @file
/// Is a derivative right? Measures the power of the step with which the Taylor remainder vanishes.
///
///     const auto energy = [&](double h) { return material.energy_density(F + h * D); };
///     const double slope = material.first_piola(F).cwiseProduct(D).sum();
///     CHECK(taylor_rate(energy, slope).is_at_least(2));
///
/// What        the order p of r(h) = |f(h) - f(0) - h f'| + |f(-h) - f(0) + h f'|, f real or an Eigen matrix,
///             |.| the sum of absolute entries
/// Equation    r = O(h^2) where f' is the derivative at 0, r = O(h) where it is not: f' needs no tolerance.
///             Two signs of h: an odd and an even term of r cannot cancel each other.
/// Method      h = 1/8, 1/16, ... down to sqrt(128 epsilon): smaller h^2 drown even where f has no other round-off.
///             The round-off of f is measured next to 0; the order is that of the smallest steps whose remainder
///             stands clear of it.
/// Valid       h = 1 should be a large change of f. Steps too large for f (NaN, infinity) are left out.
/// Blind to    relative errors of f' below about sqrt(round-off of f): 1e-6 in double, 1e-2 in float
/// Tests       tests/unit/testing/taylor_rate_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace softtissue {

/// What taylor_rate() measured.
struct TaylorRate {
    double order;   ///< power of h; NaN where f is not finite
    bool is_exact;  ///< the remainder is round-off at every step: f is a straight line as far as can be seen

    /// The remainder vanishes like h^expected or faster; 0.1 allows for the higher powers of a finite h.
    bool is_at_least(double expected) const { return is_exact || order > expected - 0.1; }
};

namespace detail {

template <RealScalar Scalar>
Scalar magnitude(Scalar x) {
    return std::abs(x);
}
template <class Derived>
typename Derived::RealScalar magnitude(const Eigen::MatrixBase<Derived>& x) {
    return x.template lpNorm<1>();  // squares could overflow
}

/// The order of `remainders`, one per halving of the step, largest step first.
inline TaylorRate order_of(std::vector<double> remainders, double noise) {
    constexpr double clear_of_noise = 32;  // 3 % of a remainder: 0.015 of its order over three halvings
    constexpr std::size_t halvings = 3;
    const auto is_finite = [](double r) { return std::isfinite(r); };
    remainders.erase(remainders.begin(), std::find_if(remainders.begin(), remainders.end(), is_finite));
    if (remainders.size() <= halvings || !is_finite(noise)) {
        return {std::numeric_limits<double>::quiet_NaN(), false};
    }
    while (!remainders.empty() && remainders.back() <= clear_of_noise * noise) {
        remainders.pop_back();
    }
    if (remainders.size() <= halvings) {
        return {std::numeric_limits<double>::infinity(), true};
    }
    const double larger = remainders[remainders.size() - 1 - halvings];
    return {std::log2(larger / remainders.back()) / double(halvings), false};
}

}  // namespace detail

/// The order of the Taylor remainder of `along` (h -> f(h)) for the claimed derivative `slope` = f'(0).
template <class Along, class Value>
TaylorRate taylor_rate(const Along& along, const Value& slope) {
    using Real = decltype(detail::magnitude(slope));
    constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
    const Value start = along(Real(0));
    const auto remainder = [&](Real h) {
        const Value forward = along(h) - start - h * slope;
        const Value backward = along(-h) - start + h * slope;
        return double(detail::magnitude(forward) + detail::magnitude(backward));
    };

    // So near to 0 that the curvature of f is below its round-off: (epsilon^(3/4))^2 < epsilon.
    const Real near_zero = std::sqrt(epsilon) * std::sqrt(std::sqrt(epsilon));
    double noise = double(epsilon * detail::magnitude(start));
    for (int j = 1; j <= 16; ++j) {
        noise = std::max(noise, remainder(near_zero * Real(j) / 16));
    }
    std::vector<double> remainders;
    for (Real h = Real(0.125); h * h >= 128 * epsilon; h /= 2) {
        remainders.push_back(remainder(h));
    }
    return detail::order_of(std::move(remainders), noise);
}

}  // namespace softtissue
