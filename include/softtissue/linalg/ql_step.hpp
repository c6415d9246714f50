// SPDX-License-Identifier: MIT
/// @file
/// An implicit QL step on a symmetric tridiagonal matrix: what makes its eigenvalues appear on the diagonal.
///
/// What        T <- G^T T G with plane rotations G of neighbouring rows, so that the step with an eigenvalue as its shift leaves
///             that eigenvalue at the top, coupled to nothing
/// Equation    G = G_{N-2} ... G_first,  T - shift I = G L with L lower triangular
/// Shapes      diagonal, below: N, rows `first` to N - 1 of which take part; below(i) couples rows i and i + 1
/// Valid       entries about 1 at most: what is below 2 epsilon beside the diagonal counts as zero. T may be of several blocks: a block
///             that has the shift for an eigenvalue lifts it to its top and from there on upwards, past the others.
/// Packs       rows stand still where `is_active` does not hold: no lane depends on the others
/// Source      Martin, Wilkinson 1968, "The Implicit QL Algorithm"; Golub & Van Loan 2013, sec. 8.3
/// Departs     an eigenvalue that a lower block has given up goes on upwards by exchanges of rows
/// Cost        a reciprocal root and 15 operations a rotation, each waiting for the one before
/// Tests       tests/unit/linalg/ql_step_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace softtissue {

/// Where an entry beside the diagonal counts.
template <RealLanes Scalar>
auto is_coupling(const Scalar& below) {
    using std::abs;
    return abs(below) > Scalar(RealOf<Scalar>(2) * std::numeric_limits<RealOf<Scalar>>::epsilon());
}

/// Wilkinson's shift for row `first`: the eigenvalue of its 2x2 matrix with the next row that is closer to its entry.
template <RealLanes Scalar, int N>
Scalar wilkinson_shift(const Eigen::Matrix<Scalar, N, 1>& diagonal, const Eigen::Matrix<Scalar, N, 1>& below,
                       int first) {
    using std::copysign;
    const Scalar one(1);
    const Scalar e = below(first);
    const Scalar ratio = (diagonal(first + 1) - diagonal(first)) * reciprocal(Scalar(e + e));
    const Scalar root = quick_sqrt(Scalar(ratio * ratio + one));
    return diagonal(first) - e * reciprocal(Scalar(ratio + copysign(root, ratio)));
}

/// One step where `is_active`; rotate(i, cosine, sine) is told each rotation, of columns q_i and q_{i+1} into
/// cosine q_i - sine q_{i+1} and sine q_i + cosine q_{i+1}, from the bottom up.
template <RealLanes Scalar, int N, class Mask, class Rotate>
void ql_step(const Mask& is_active, int first, const Scalar& shift, Eigen::Matrix<Scalar, N, 1>& diagonal,
             Eigen::Matrix<Scalar, N, 1>& below, const Rotate& rotate) {
    const Scalar zero(0), one(1);
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    const Scalar smallest(Limits::min() / Limits::epsilon());  // below it squares have no digits
    Scalar s = one, c = one, p = zero, g = zero;
    auto is_inside = one < zero;  // a block that began below
    for (int i = N - 2; i >= first; --i) {
        const Scalar e = below(i);
        s = select(is_inside, s, one);
        c = select(is_inside, c, one);
        p = select(is_inside, p, zero);
        g = select(is_inside, g, Scalar(diagonal(i + 1) - shift));
        const Scalar f = s * e, b = c * e;
        const Scalar squared = f * f + g * g;
        const Scalar inverse = reciprocal_sqrt(squared);
        const auto is_linked = is_coupling(e);
        const auto is_exchanged = (is_linked & (squared < smallest)) | ((!is_linked) & (!is_coupling(g)));
        const auto is_turning = is_active & is_linked & (!is_exchanged);
        const Scalar length = squared * inverse;
        below(i + 1) = select(is_active, select(is_inside, select(is_turning, length, g), zero), below(i + 1));
        s = select(is_turning, Scalar(f * inverse), select(is_active & is_exchanged, one, zero));
        c = select(is_turning, Scalar(g * inverse), select(is_active & is_exchanged, zero, one));
        is_inside = is_linked | is_exchanged;
        const Scalar rest = diagonal(i + 1) - p;
        const Scalar r = (diagonal(i) - rest) * s + c * (b + b);
        p = s * r;
        diagonal(i + 1) = select(is_active, Scalar(rest + p), diagonal(i + 1));
        g = c * r - b;
        rotate(i, c, s);
    }
    diagonal(first) = select(is_active, Scalar(diagonal(first) - p), diagonal(first));
    below(first) = select(is_active, g, below(first));
}

}  // namespace softtissue
