// SPDX-License-Identifier: MIT
/// @file
/// The real roots of a cubic in an interval.
///
/// What        every root in [low, high] where c_0 + c_1 s + c_2 s^2 + c_3 s^3 changes sign, ascending
/// Method      the extrema (roots of the derivative) cut the interval into monotone pieces; in a piece whose ends differ
///             in sign, Newton steps that leave the bracket are replaced by bisection.
/// Valid       any finite coefficients, leading zeros included. Where the cubic only touches zero, round-off decides
///             between no root and two.
/// Cost        at most three brackets, five or so iterations each, 200 in the worst case
/// Tests       tests/unit/linalg/cubic_roots_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace softtissue {

/// Coefficients c_0 .. c_3 of ascending powers.
template <RealScalar Real>
using Cubic = std::array<Real, 4>;

template <RealScalar Real>
struct CubicRoots {
    std::array<Real, 3> values{};
    int count = 0;
};

namespace detail {

template <RealScalar Real>
Real cubic_value(const Cubic<Real>& c, Real s) {
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

/// The root in [low, high], where the cubic is monotone and its values at the ends differ in sign.
template <RealScalar Real>
Real bracketed_root(const Cubic<Real>& c, Real low, Real high) {
    const bool is_rising = cubic_value(c, low) < cubic_value(c, high);
    Real s = (low + high) / Real(2);
    for (int iteration = 0; iteration < 200; ++iteration) {
        const Real value = cubic_value(c, s);
        const Cubic<Real> size{std::abs(c[0]), std::abs(c[1]), std::abs(c[2]), std::abs(c[3])};
        if (std::abs(value) <= std::numeric_limits<Real>::epsilon() * cubic_value(size, std::abs(s))) {
            break;  // as small as rounding lets it be
        }
        ((value < Real(0)) == is_rising ? low : high) = s;
        s -= value / (c[1] + s * (Real(2) * c[2] + s * Real(3) * c[3]));
        if (!(s > low && s < high)) {
            s = (low + high) / Real(2);
        }
    }
    return s;
}

}  // namespace detail

/// The sign changes of the cubic `c` in [low, high], ascending.
template <RealScalar Real>
CubicRoots<Real> cubic_roots(const Cubic<Real>& c, Real low, Real high) {
    // Extrema: 3 c3 s^2 + 2 c2 s + c1 = 0, without cancellation; a vanishing c3 gives an infinite one, clamped away.
    std::array<Real, 4> knots{low, high, high, high};
    const Real discriminant = c[2] * c[2] - Real(3) * c[3] * c[1];
    if (discriminant > Real(0)) {
        const Real q = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
        const Real first = q / (Real(3) * c[3]);
        const Real second = c[1] / q;
        knots[1] = std::clamp(std::min(first, second), low, high);
        knots[2] = std::clamp(std::max(first, second), low, high);
    }
    CubicRoots<Real> roots;
    for (std::size_t piece = 0; piece < 3; ++piece) {
        const Real a = knots[piece];
        const Real b = knots[piece + 1];
        // Half-open pieces, so that a root at a knot is found once.
        const bool starts_negative = detail::cubic_value(c, a) < Real(0);
        const bool ends_negative = detail::cubic_value(c, b) < Real(0);
        if (a < b && starts_negative != ends_negative) {
            roots.values[std::size_t(roots.count++)] = detail::bracketed_root(c, a, b);
        }
    }
    return roots;
}

}  // namespace softtissue
