// SPDX-License-Identifier: MIT
/// @file
/// Takes the smallest eigenvalue off a symmetric tridiagonal matrix.
///
/// What        T <- G^T T G with G e_first the eigenvector: the eigenvalue comes to the top, coupled to nothing
/// Equation    pivots of T - lambda I from the top, a_i, and from the bottom, b_i; where |a_i + b_i - (d_i - lambda)| is least the
///             eigenvector is 1, from there z_i = -e_i / a_i z_{i+1} upwards and z_{i+1} = -e_i / b_{i+1} z_i downwards;
///             plane rotations of rows i and i + 1 by c_i = z_i / t_i, s_i = -t_{i+1} / t_i, t_i^2 = sum_{j >= i} z_j^2, from the bottom up
/// Shapes      diagonal d, below e: N, rows `first` to N - 1 of which take part; below(i) couples rows i and i + 1
/// Valid       lambda to a few epsilon, not above all others of T by more: the pivots are positive, and no ratio grows
/// Accuracy    what the rotations leave beside the tridiagonal is dropped where it is below 4 epsilon; elsewhere, and where lambda was
///             not the smallest, nothing is done
/// Packs       no branch: no lane depends on the others
/// Source      the eigenvector: Dhillon, Parlett 2004, "Orthogonal eigenvectors and relative gaps" (twisted factorisation); what a QL
///             step with a perfect shift lacks: Parlett, Le 1993, "Forward instability of tridiagonal QR"
/// Why         a QL step with this shift leaves up to a thousand epsilon and waits for a root in each row; here a quotient a row, the rest
///             is side by side
/// Tests       tests/unit/linalg/tridiagonal_deflation_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

namespace detail {

/// The eigenvector of rows `first` to N - 1 for the smallest eigenvalue, of any length; its largest entries are about 1.
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, 1> tridiagonal_eigenvector(const Scalar& eigenvalue, int first,
                                                    const Eigen::Matrix<Scalar, N, 1>& diagonal,
                                                    const Eigen::Matrix<Scalar, N, 1>& below) {
    using std::abs;
    using std::max;
    using Real = RealOf<Scalar>;
    using Vector = Eigen::Matrix<Scalar, N, 1>;
    const Scalar one(1);
    const Scalar smallest(std::numeric_limits<Real>::epsilon() * std::numeric_limits<Real>::epsilon());
    Vector from_top, from_bottom, upwards, downwards;
    from_top(first) = diagonal(first) - eigenvalue;
    for (int i = first; i + 1 < N; ++i) {
        upwards(i) = -below(i) / max(from_top(i), smallest);
        from_top(i + 1) = (diagonal(i + 1) - eigenvalue) + below(i) * upwards(i);
    }
    from_bottom(N - 1) = diagonal(N - 1) - eigenvalue;
    for (int i = N - 2; i >= first; --i) {
        downwards(i) = -below(i) / max(from_bottom(i + 1), smallest);
        from_bottom(i) = (diagonal(i) - eigenvalue) + below(i) * downwards(i);
    }
    Scalar least = abs(from_bottom(first)), twist{Real(first)};
    for (int i = first + 1; i < N; ++i) {
        const Scalar size = abs(from_top(i) + (from_bottom(i) - (diagonal(i) - eigenvalue)));
        const auto is_less = size < least;
        least = select(is_less, size, least);
        twist = select(is_less, Scalar(Real(i)), twist);
    }
    Vector z;
    Scalar next = one;
    for (int i = N - 1; i >= first; --i) {
        const Scalar index{Real(i)};
        next = select(index < twist, Scalar(i + 1 < N ? Scalar(upwards(i) * next) : one), one);
        z(i) = next;
    }
    Scalar before = one;
    for (int i = first; i + 1 < N; ++i) {
        const Scalar index{Real(i)};
        before = select(index < twist, one, Scalar(downwards(i) * before));
        z(i + 1) = select(index < twist, z(i + 1), before);
    }
    return z;
}

}  // namespace detail

/// Takes `eigenvalue` off the rows from `first` on where `is_wanted`; where it could. The rotations: columns q_i and q_{i+1} become
/// cosine q_i - sine q_{i+1} and sine q_i + cosine q_{i+1}, from the bottom up.
template <RealLanes Scalar, int N, class Mask>
Mask deflate(const Mask& is_wanted, const Scalar& eigenvalue, int first, Eigen::Matrix<Scalar, N, 1>& diagonal,
             Eigen::Matrix<Scalar, N, 1>& below, Eigen::Matrix<Scalar, N, 1>& cosines,
             Eigen::Matrix<Scalar, N, 1>& sines) {
    using std::abs;
    using Real = RealOf<Scalar>;
    using Vector = Eigen::Matrix<Scalar, N, 1>;
    const Scalar zero(0), one(1);
    const Vector z = detail::tridiagonal_eigenvector(eigenvalue, first, diagonal, below);
    // Below it squares have no digits, and what is left of z counts as zero.
    const Scalar smallest(std::numeric_limits<Real>::min() / std::numeric_limits<Real>::epsilon());
    Scalar tail = z(N - 1) * z(N - 1), length = z(N - 1);
    for (int i = N - 2; i >= first; --i) {
        const Scalar squared = tail + z(i) * z(i);
        const auto is_turning = squared > smallest;
        const Scalar inverse = reciprocal_sqrt(squared);
        cosines(i) = select(is_turning, Scalar(z(i) * inverse), one);
        sines(i) = select(is_turning, Scalar(-(length * inverse)), zero);
        tail = select(is_turning, squared, zero);
        length = select(is_turning, Scalar(squared * inverse), zero);
    }
    Vector new_diagonal, new_below;
    const Scalar negligible(Real(4) * std::numeric_limits<Real>::epsilon());
    // A vector that has grown is none: the eigenvalue was not the smallest.
    auto is_done = is_wanted & (tail < Scalar(Real(1) / std::numeric_limits<Real>::epsilon()));
    Scalar s = zero, c = one, p = zero, g = zero;
    for (int i = N - 2; i >= first; --i) {
        const Scalar f = s * below(i), b = c * below(i);
        s = sines(i), c = cosines(i);
        new_below(i + 1) = s * f + c * g;
        is_done = is_done & (Scalar(abs(c * f - s * g)) < negligible);
        const Scalar own = (diagonal(i) - diagonal(i + 1)) * s + c * (b + b);
        const Scalar r = own + s * p;
        new_diagonal(i + 1) = diagonal(i + 1) - p;
        p = s * own + (s * s) * p;
        new_diagonal(i + 1) += p;
        g = c * r - b;
    }
    new_diagonal(first) = diagonal(first) - p;
    new_below(first) = g;
    is_done = is_done & (Scalar(abs(g)) < negligible);
    for (int i = first; i < N; ++i) {
        diagonal(i) = select(is_done, new_diagonal(i), diagonal(i));
        below(i) = select(is_done, new_below(i), below(i));
        cosines(i) = select(is_done, cosines(i), one);
        sines(i) = select(is_done, sines(i), zero);
    }
    below(first) = select(is_done, zero, below(first));
    return is_done;
}

}  // namespace softtissue
