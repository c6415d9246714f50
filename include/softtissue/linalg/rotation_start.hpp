// SPDX-License-Identifier: MIT
/// @file
/// A quaternion near that of the rotation nearest to a 3x3 matrix, without iterating on matrices.
///
/// What        the start of Newton's method (rotation_newton.hpp) where no former fit is at hand
/// Equation    tr(R(q)^T F) = q^T K q: the eigenvector of K for its largest eigenvalue l, a column of adj(K - l I). With |F| = 1
///             l is the largest root of (l^2 - 1)^2 - 8 l det F - 4 |cof F|^2, by four steps of Newton's method from sqrt(3),
///             where it is for rotations and above which it never is
///             K = [tr F, a^T; a, F + F^T - tr F I],  a = (F_21 - F_12, F_02 - F_20, F_10 - F_01)
/// Shapes      F 3x3, q 4 = (w, x, y, z); lane by lane for packs
/// Valid       good to some digits where the two smallest stretches do not nearly cancel; elsewhere any quaternion, not finite
///             where F is zero or out of range. Newton's method says which it was.
/// Source      the matrix K: Horn 1987, "Closed-form Solution of Absolute Orientation Using Unit Quaternions"
/// Cost        about 200 flop, two roots and six divisions
/// Tests       tests/unit/linalg/rotation_start_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <cmath>
#include <numbers>

namespace softtissue {

namespace detail {

/// The largest eigenvalue of K for a matrix of norm 1.
template <RealLanes Scalar>
[[gnu::always_inline]] inline Scalar largest_rotation_root(const Matrix3<Scalar>& F) {
    constexpr int num_steps = 4;
    const Matrix3<Scalar> cof = cofactor(F);
    const Scalar constant = Scalar(4) * cof.squaredNorm();
    const Scalar linear = Scalar(8) * determinant(F, cof);
    Scalar root(std::numbers::sqrt3_v<RealOf<Scalar>>);
    for (int step = 0; step < num_steps; ++step) {
        const Scalar excess = root * root - Scalar(1);
        root -= (excess * excess - linear * root - constant) * reciprocal(Scalar(Scalar(4) * root * excess - linear));
    }
    return root;
}

/// The column of the adjugate of a symmetric 4x4 matrix with the largest diagonal entry.
template <RealLanes Scalar>
[[gnu::always_inline]] inline Quaternion<Scalar> largest_adjugate_column(const Eigen::Matrix<Scalar, 4, 4>& M) {
    using std::abs;
    const auto upper = [&](int i, int j) { return Scalar(M(0, i) * M(1, j) - M(0, j) * M(1, i)); };
    const auto lower = [&](int i, int j) { return Scalar(M(2, i) * M(3, j) - M(2, j) * M(3, i)); };
    const Scalar u01 = upper(0, 1), u02 = upper(0, 2), u03 = upper(0, 3);
    const Scalar u12 = upper(1, 2), u13 = upper(1, 3), u23 = upper(2, 3);
    const Scalar l02 = lower(0, 2), l03 = lower(0, 3), l12 = lower(1, 2), l13 = lower(1, 3), l23 = lower(2, 3);
    const Scalar a00 = M(1, 1) * l23 - M(1, 2) * l13 + M(1, 3) * l12;
    const Scalar a01 = M(0, 2) * l13 - M(0, 1) * l23 - M(0, 3) * l12;
    const Scalar a02 = M(3, 1) * u23 - M(3, 2) * u13 + M(3, 3) * u12;
    const Scalar a03 = M(2, 2) * u13 - M(2, 1) * u23 - M(2, 3) * u12;
    const Scalar a11 = M(0, 0) * l23 - M(0, 2) * l03 + M(0, 3) * l02;
    const Scalar a12 = M(3, 2) * u03 - M(3, 0) * u23 - M(3, 3) * u02;
    const Scalar a13 = M(2, 0) * u23 - M(2, 2) * u03 + M(2, 3) * u02;
    const Scalar a22 = M(3, 0) * u13 - M(3, 1) * u03 + M(3, 3) * u01;
    const Scalar a23 = M(2, 1) * u03 - M(2, 0) * u13 - M(2, 3) * u01;
    const Scalar a33 = M(2, 0) * u12 - M(2, 1) * u02 + M(2, 2) * u01;
    const Scalar d0 = abs(a00), d1 = abs(a11), d2 = abs(a22), d3 = abs(a33);
    const auto is_0 = (d0 >= d1) & (d0 >= d2) & (d0 >= d3);
    const auto is_1 = (d1 >= d2) & (d1 >= d3);
    const auto is_2 = d2 >= d3;
    const auto choose = [&](const Scalar& x0, const Scalar& x1, const Scalar& x2, const Scalar& x3) {
        return select(is_0, x0, select(is_1, x1, select(is_2, x2, x3)));
    };
    return {choose(a00, a01, a02, a03), choose(a01, a11, a12, a13), choose(a02, a12, a22, a23),
            choose(a03, a13, a23, a33)};
}

}  // namespace detail

/// The unit quaternion; see the file comment.
template <RealLanes Scalar>
Quaternion<Scalar> rotation_start(const Matrix3<Scalar>& F) {
    const Matrix3<Scalar> G = F * reciprocal_sqrt(Scalar(F.squaredNorm()));
    const Scalar root = detail::largest_rotation_root(G);
    const Scalar trace = G(0, 0) + G(1, 1) + G(2, 2);
    Eigen::Matrix<Scalar, 4, 4> M;
    M(0, 0) = trace - root;
    M(0, 1) = M(1, 0) = G(2, 1) - G(1, 2);
    M(0, 2) = M(2, 0) = G(0, 2) - G(2, 0);
    M(0, 3) = M(3, 0) = G(1, 0) - G(0, 1);
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            M(i + 1, j + 1) = G(i, j) + G(j, i);
        }
        M(j + 1, j + 1) -= trace + root;
    }
    const Quaternion<Scalar> q = detail::largest_adjugate_column(M);
    return q * reciprocal_sqrt(Scalar(q.dot(q)));
}

}  // namespace softtissue
