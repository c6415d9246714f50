// SPDX-License-Identifier: MIT
/// @file
/// The rotation nearest to a 3x3 matrix, and its derivative.
///
/// What        R(F) = U V^T of the signed singular value decomposition: det R = +1 for every F, inverted ones included;
///             from a quaternion of its own or one that is given, or from the decomposition where that is at hand
/// Equation    R = argmin |F - R|^2 over rotations;
///             dR/dF = sum_{i<j} q_ij q_ij^T / (s_i + s_j),  q_ij = vec(u_i v_j^T - u_j v_i^T)
/// Shapes      F, R: 3x3.  dR/dF: 9x9 on column-major vec(F), symmetric, positive semi-definite, rank 3.
/// Valid       R: every finite F.  Not unique, and not differentiable, where s_1 + s_2 = 0 (s_2 the signed smallest
///             singular value: inverted or rank-one F whose two smallest stretches cancel).  There R is one of the
///             minimisers, and the denominators are kept at or above epsilon, so the derivative stays finite.
/// Source      derivative: Smith, de Goes, Kim 2019, sec. 4 (twist modes)
/// Cost        R: rotation_start.hpp (not from a given quaternion), rotation_newton.hpp, and one svd3 where Newton's method does
///             not get there (for a pack: in any lane).  The derivative: one svd3 and three rank-one updates.
/// Tests       tests/unit/linalg/polar_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/linalg/rotation_newton.hpp>
#include <softtissue/linalg/rotation_start.hpp>
#include <softtissue/linalg/svd3.hpp>

#include <algorithm>
#include <limits>

namespace softtissue {

/// The proper rotation of a decomposed matrix.
template <RealLanes Scalar>
Matrix3<Scalar> polar_rotation(const Svd3<Scalar>& svd) {
    return svd.U * svd.V.transpose();
}

/// The rotation nearest to F, det = +1, from that of the quaternion q, the faster the nearer it is; q becomes that of the result.
template <RealLanes Scalar>
Matrix3<Scalar> polar_rotation(const Matrix3<Scalar>& F, Quaternion<Scalar>& q) {
    const auto is_reached = refine_rotation(F, q);
    if (!all_of(is_reached)) {
        const Quaternion<Scalar> decomposed = quaternion_from_rotation_matrix(polar_rotation(svd3(F)));
        for (int k = 0; k < 4; ++k) {
            q(k) = select(is_reached, q(k), decomposed(k));
        }
    }
    return rotation_matrix_from_quaternion(q);
}

/// The rotation nearest to F, det = +1.
template <RealLanes Scalar>
Matrix3<Scalar> polar_rotation(const Matrix3<Scalar>& F) {
    Quaternion<Scalar> q = rotation_start(F);
    return polar_rotation(F, q);
}

/// s_i + s_j, the stiffness of the rotation against turning in the plane (i, j), kept at or above epsilon.
template <RealLanes Scalar>
Scalar twist_denominator(const Vector3<Scalar>& sigma, int i, int j) {
    using std::max;
    return max(Scalar(sigma(i) + sigma(j)), Scalar(std::numeric_limits<RealOf<Scalar>>::epsilon()));
}

/// d vec(R) / d vec(F) of a decomposed matrix.
template <RealLanes Scalar>
Matrix9<Scalar> drotation_dgradient(const Svd3<Scalar>& svd) {
    Matrix9<Scalar> derivative = Matrix9<Scalar>::Zero();
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        const Matrix3<Scalar> Q = svd.U.col(i) * svd.V.col(j).transpose() - svd.U.col(j) * svd.V.col(i).transpose();
        const Vector9<Scalar> q = vec(Q);
        const Scalar weight = Scalar(1) / twist_denominator(svd.sigma, i, j);
        for (int column = 0; column < 9; ++column) {
            const Scalar weighted = weight * q(column);
            for (int row = column; row < 9; ++row) {
                derivative(row, column) += weighted * q(row);
            }
        }
    }
    for (int column = 1; column < 9; ++column) {
        for (int row = 0; row < column; ++row) {
            derivative(row, column) = derivative(column, row);
        }
    }
    return derivative;
}

/// d vec(R) / d vec(F).
template <RealLanes Scalar>
Matrix9<Scalar> drotation_dgradient(const Matrix3<Scalar>& F) {
    return drotation_dgradient(svd3(F));
}

}  // namespace softtissue
