// SPDX-License-Identifier: MIT
/// @file
/// The smallest eigenvalue of a symmetric tridiagonal matrix by Laguerre's method.
///
/// What        eigenvalue_bound, has_only_eigenvalues_above, smallest_eigenvalue of rows `first` to N - 1
/// Equation    p_k(x) = (d_k - x) p_{k-1} - e_{k-1}^2 p_{k-2}, the leading minors of T - x I; with p the last one, n its degree,
///             x <- x - n r / (1 + sqrt((n - 1) (n - 1 - n q))),  r = p / p',  q = p p'' / p'^2
/// Shapes      diagonal d, below e: N; below(i) couples rows i and i + 1
/// Valid       entries about 1 at most. From the left of all eigenvalues the method rises to the smallest; from elsewhere it finds
///             one nearby.
/// Accuracy    a few epsilon where the eigenvalue is well apart from the others; of close ones half of the digits
/// Packs       a lane that has found its eigenvalue stands still while others go on, so that it never depends on them
/// Source      Parlett 1964, "Laguerre's Method Applied to the Matrix Eigenvalue Problem"; the bound: Samuelson 1968, Gershgorin
/// Cost        12 operations a row and step, three chains of one multiply-add a row; four or five steps
/// Tests       tests/unit/linalg/tridiagonal_laguerre_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

/// A lower bound of all eigenvalues.
template <RealLanes Scalar, int N>
Scalar eigenvalue_bound(const Eigen::Matrix<Scalar, N, 1>& diagonal, const Eigen::Matrix<Scalar, N, 1>& below) {
    using std::abs;
    using std::max;
    using std::min;
    using std::sqrt;
    using Real = RealOf<Scalar>;
    Scalar trace = diagonal(0), squares = diagonal(0) * diagonal(0);
    Scalar disc = diagonal(0) - abs(below(0));
    for (int i = 1; i < N; ++i) {
        trace += diagonal(i);
        squares += diagonal(i) * diagonal(i) + Real(2) * (below(i - 1) * below(i - 1));
        disc = min(disc, Scalar(diagonal(i) - abs(below(i - 1)) - (i + 1 < N ? Scalar(abs(below(i))) : Scalar(0))));
    }
    const Scalar mean = trace * (Real(1) / Real(N));
    const Scalar variance = max(Scalar(0), Scalar(squares * (Real(1) / Real(N)) - mean * mean));
    return max(disc, Scalar(mean - sqrt(Scalar(variance * Real(N - 1)))));
}

/// Where all eigenvalues of the rows from `first` on lie above `bound`, and by so much that no minor is too small for a number.
template <RealLanes Scalar, int N>
auto has_only_eigenvalues_above(const Scalar& bound, int first, const Eigen::Matrix<Scalar, N, 1>& diagonal,
                                const Eigen::Matrix<Scalar, N, 1>& below) {
    const Scalar zero(0);
    Scalar before(1), minor = diagonal(first) - bound;
    auto is_above = minor > zero;
    for (int i = first + 1; i < N; ++i) {
        const Scalar next = (diagonal(i) - bound) * minor - (below(i - 1) * below(i - 1)) * before;
        before = minor;
        minor = next;
        is_above = is_above & (minor > zero);
    }
    return is_above;
}

/// An eigenvalue of the rows from `first` on, the smallest if `start` lies below all; `start` where not `is_searching`.
template <RealLanes Scalar, int N, class Mask>
Scalar smallest_eigenvalue(const Scalar& start, Mask is_searching, int first,
                           const Eigen::Matrix<Scalar, N, 1>& diagonal, const Eigen::Matrix<Scalar, N, 1>& below) {
    using std::abs;
    using std::max;
    using std::sqrt;
    using Real = RealOf<Scalar>;
    constexpr int max_steps = 12;
    const Scalar zero(0), one(1), longest(4);
    const Scalar tolerance(std::numeric_limits<Real>::epsilon());
    const auto degree = Real(N - first), less = degree - Real(1);
    Scalar x = start, last_change = zero;
    for (int step = 0; step < max_steps && any_of(is_searching); ++step) {
        // p and its Taylor coefficients, of this row and the one before
        Scalar p0(1), q0(0), r0(0);
        Scalar p = diagonal(first) - x, q(-1), r(0);
        for (int i = first + 1; i < N; ++i) {
            const Scalar a = diagonal(i) - x, b = below(i - 1) * below(i - 1);
            const Scalar p1 = a * p - b * p0;
            const Scalar q1 = a * q - (p + b * q0);
            const Scalar r1 = a * r - (q + b * r0);
            p0 = p, q0 = q, r0 = r;
            p = p1, q = q1, r = r1;
        }
        const Scalar inverse = one / q;
        const Scalar newton = p * inverse;
        const Scalar curvature = Real(2) * newton * (r * inverse);
        const Scalar root = sqrt(Scalar(max(zero, Scalar(less * (less - degree * curvature)))));
        const Scalar change = degree * newton / (one + root);
        // Where numbers leave their range no step is better.
        is_searching = is_searching & (abs(change) < longest);
        x -= select(is_searching, change, zero);
        // The error falls with its third power: the next step would be change^4 / last_change^3.
        const Scalar squared = change * change;
        is_searching = is_searching & (squared * squared > tolerance * abs(last_change * last_change * last_change));
        last_change = change;
    }
    return x;
}

}  // namespace softtissue
