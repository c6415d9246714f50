// SPDX-License-Identifier: MIT
/// @file
/// From what a network predicts of every cell to its target gradient, in one pass over the cells.
///
/// What        exponential, blended rotation and their product, 32 cells at a time
/// Equation    F_p^res = exp(Q_p),  T_p = R_p F_p^res,  R_p the blended rotation of the bones
/// Shapes      Q and residuals 9 x cells, a 3x3 a column, row after row (as PyTorch flattens it); bones: one unit quaternion
///             a joint; targets 3 x 3 cells (T_p in columns 3p to 3p + 2)
/// Refuses     arrays of different sizes, a bone that is not finite (InvalidInput)
/// Source      Nolte et al. 2026, eq. (11), (12) and (14) to (16)
/// Cost        that of the exponentials, 8 flop a bone and 75 a cell. Nothing is allocated once the targets have their size.
///             Same bits for every executor.
/// Tests       tests/unit/ndg/rotated_exponentials_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_mask.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/matrix3_entries.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/blended_rotation.hpp>

#include <span>

namespace softtissue {

namespace detail {

/// R F of 32 cells, R of quaternions by components; entries column after column.
template <RealScalar N, RealScalar S>
void rotate_lanes(const S (&quaternions)[4][Matrix3Lanes<S>::lanes], const Matrix3Lanes<N>& F, Matrix3Lanes<S>& T) {
    using Lanes = Pack<S, natural_lanes<S>>;
    constexpr int lanes = natural_lanes<S>;
    for (int l = 0; l < Matrix3Lanes<S>::lanes; l += lanes) {
        Quaternion<Lanes> q;
        for (int k = 0; k < 4; ++k) {
            q(k) = Lanes::load(quaternions[k] + l);
        }
        const Matrix3<Lanes> R = rotation_matrix_from_quaternion(q);
        for (int j = 0; j < 3; ++j) {
            Lanes column[3];
            for (int k = 0; k < 3; ++k) {
                column[k] = Lanes::from_lanes([&](int i) { return S(F.e[3 * k + j][l + i]); });
            }
            for (int i = 0; i < 3; ++i) {
                (R(i, 0) * column[0] + R(i, 1) * column[1] + R(i, 2) * column[2]).store(T.e[3 * j + i] + l);
            }
        }
    }
}

}  // namespace detail

template <RealScalar N, RealScalar S, Executor E = SequentialExecutor>
void rotated_exponentials_into(ConstRef<Matrix9X<N>> Q, const BlendedRotations<S>& blended,
                               std::span<const Quaternion<S>> bones, Eigen::Ref<Matrix9X<N>> residuals,
                               Matrix3X<S>& targets, const E& executor = {}) {
    require(Q.cols() == blended.num_rows() && residuals.cols() == Q.cols(), "rotated exponentials: ", Q.cols(),
            " matrices and room for ", residuals.cols(), ", expected ", blended.num_rows());
    require(Index(bones.size()) == blended.num_joints(), "rotated exponentials: ", bones.size(), " bones, expected ",
            blended.num_joints());
    blended.require_bones(bones);
    targets.resize(3, 3 * Q.cols());
    for_each_exponential_block<N>(
        Q,
        [&](Index first, Index count, const Matrix3Lanes<N>& exponentials) {
            exponentials.store(residuals.col(first).data(), residuals.outerStride(), count);
            alignas(64) S quaternions[4][Matrix3Lanes<S>::lanes] = {};
            for (Index l = 0; l < count; ++l) {
                const Quaternion<S> q = blended_quaternion<S>(bones, blended.row(first + l));
                for (int k = 0; k < 4; ++k) {
                    quaternions[k][l] = q(k);
                }
            }
            Matrix3Lanes<S> T;
            detail::rotate_lanes(quaternions, exponentials, T);
            T.store(targets.col(3 * first).data(), 9, count);
        },
        executor);
}

}  // namespace softtissue
