// SPDX-License-Identifier: MIT
/// @file
/// Newton's method for the rotation nearest to a 3x3 matrix, from a start that is near.
///
/// What        turns a unit quaternion until R^T F is symmetric, and says where it got there
/// Equation    R <- R exp([w]),  (tr(S) I - sym S) w = (S_21 - S_12, S_02 - S_20, S_10 - S_01),  S = R^T F;
///             exp by the quaternion (1 + |w/2|^2, w/2) normalised, which turns by the right angle up to |w|^5 where F is a rotation.
///             What is left is below |w|^3 / (4 (s_1 + s_2)) of the two smallest singular values (s_2 signed, the largest one 1).
/// Shapes      F 3x3, q 4 = (w, x, y, z); for packs the start, the steps and the outcome of each lane are its own
/// Valid       it got there where the last step was so short that what is left of it is below epsilon / (3 (s_1 + s_2)), and
///             where tr(S) I - sym S is positive definite: of the rotations where R^T F is symmetric only the nearest has that.
///             Elsewhere (a start too far away, two smallest stretches that nearly cancel, F not finite) q is any quaternion.
/// Source      Mueller et al. 2016, "A Robust Method to Extract the Rotational Part of Deformations", with the exact Hessian
/// Cost        about 130 flop, a root and two divisions a step; 2 steps from two degrees
/// Tests       tests/unit/linalg/rotation_newton_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <cmath>
#include <limits>

namespace softtissue {

/// Where the quaternion became that of the nearest rotation; at most `max_steps` steps.
template <RealLanes Scalar>
auto refine_rotation(const Matrix3<Scalar>& F, Quaternion<Scalar>& q, int max_steps = 6) {
    const Scalar zero(0), one(1), half(RealOf<Scalar>(0.5));
    const Scalar short_step(std::numeric_limits<RealOf<Scalar>>::digits < 50 ? 0x1p-17 : 0x1p-37);  // |w/2|^2
    const Scalar largest(std::numeric_limits<RealOf<Scalar>>::max());  // beyond, steps would be zero
    auto is_done = one < zero;
    for (int step = 0; step < max_steps; ++step) {
        const Matrix3<Scalar> R = rotation_matrix_from_quaternion<Scalar>(q);
        const Matrix3<Scalar> S = R.transpose() * F;
        // M = tr(S) I - sym S and its cofactors, both symmetric.
        const Scalar m00 = S(1, 1) + S(2, 2), m11 = S(2, 2) + S(0, 0), m22 = S(0, 0) + S(1, 1);
        const Scalar m01 = -half * (S(0, 1) + S(1, 0)), m02 = -half * (S(0, 2) + S(2, 0)),
                     m12 = -half * (S(1, 2) + S(2, 1));
        const Scalar c00 = m11 * m22 - m12 * m12, c01 = m02 * m12 - m01 * m22, c02 = m01 * m12 - m02 * m11;
        const Scalar c11 = m00 * m22 - m02 * m02, c12 = m01 * m02 - m00 * m12, c22 = m00 * m11 - m01 * m01;
        const Scalar determinant = m00 * c00 + m01 * c01 + m02 * c02;
        const Scalar scale = half * reciprocal(determinant);
        const Scalar a0 = S(2, 1) - S(1, 2), a1 = S(0, 2) - S(2, 0), a2 = S(1, 0) - S(0, 1);
        const Scalar h0 = scale * (c00 * a0 + c01 * a1 + c02 * a2);
        const Scalar h1 = scale * (c01 * a0 + c11 * a1 + c12 * a2);
        const Scalar h2 = scale * (c02 * a0 + c12 * a1 + c22 * a2);
        const Scalar squared = h0 * h0 + h1 * h1 + h2 * h2;
        const Quaternion<Scalar> turned = quaternion_product<Scalar>(q, {one + squared, h0, h1, h2});
        const Scalar inverse_length = reciprocal_sqrt(Scalar(turned.dot(turned)));
        for (int k = 0; k < 4; ++k) {
            q(k) = select(is_done, q(k), Scalar(turned(k) * inverse_length));
        }
        // The short step changes no eigenvalue of M by more than |w|^2 times the largest singular value, so that M stays definite.
        const Scalar trace = m00 + m11 + m22;
        const Scalar change = (squared * trace) * (trace * trace);
        is_done = is_done | ((squared < short_step) & (m00 > zero) & (c22 > zero) & (determinant > change) &
                             (determinant <= largest));
        if (all_of(is_done)) {
            break;
        }
    }
    return is_done;
}

}  // namespace softtissue
