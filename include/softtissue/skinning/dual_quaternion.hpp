// SPDX-License-Identifier: MIT
/// @file
/// Dual quaternion skinning: a rigid blend of rigid joint transforms.
///
/// What        a SkinningPolicy whose blended transforms are rotations plus translations.
/// Equation    q = sum_j w_j s_j (q_j + eps e_j),  e_j = (0, t_j) q_j / 2;  result: the rigid motion of q / |real(q)|
///             s_j = sign(q_j . q_pivot), pivot = the joint of largest weight, the lowest index of several
/// Shapes      prepared: (8 + joints) x joints, column j = (q_j, e_j, sign(q_j . q_k) for each joint k), quaternions (w, x, y, z).
/// Valid       rigid joint transforms. The blend takes the shorter way round: as a function of the pose it is
///             continuous except where a joint and the pivot differ by exactly pi.
/// Refuses     a joint transform that is not rigid within rigid_tolerance (InvalidInput names the joint).
/// Source      Kavan et al. 2008, "Geometric Skinning with Approximate Dual Quaternion Blending", alg. 1
/// Cost        16 flop per influence, 60 flop and one division per vertex
/// Tests       tests/unit/skinning/dual_quaternion_test.cpp, laws: tests/laws/skinning_laws_test.cpp
#pragma once

#include <softtissue/skinning/concepts.hpp>

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/linalg/quaternion.hpp>

namespace softtissue {

template <FieldScalar S>
struct DualQuaternion {
    using Scalar = S;

    /// Entries of A^T A - I; single-precision chains of joints stay far below, scaled bones far above.
    static constexpr RealOf<S> rigid_tolerance = RealOf<S>(1e-4);

    void prepare_into(std::span<const AffineTransform<S>> joint_transforms, MatrixX<S>& prepared) const {
        const Index num_joints = Index(joint_transforms.size());
        prepared.resize(8 + num_joints, num_joints);
        for (Index j = 0; j < num_joints; ++j) {
            const AffineTransform<S>& T = joint_transforms[size_t(j)];
            require(is_rotation(T.linear, rigid_tolerance), "dual quaternion skinning: transform of joint ", j,
                    " is not rigid, expected a rotation and a translation");
            const Quaternion<S> q = quaternion_from_rotation_matrix(T.linear);
            const Quaternion<S> t(S(0), T.translation(0), T.translation(1), T.translation(2));
            prepared.col(j).template head<8>() << q, S(0.5) * quaternion_product(t, q);
            for (Index k = 0; k <= j; ++k) {
                const S cosine = prepared.col(j).template head<4>().dot(prepared.col(k).template head<4>());
                prepared(8 + k, j) = prepared(8 + j, k) = S(value_of(cosine) < 0 ? -1 : 1);
            }
        }
    }

    AffineTransform<S> blend(const MatrixX<S>& prepared, std::span<const JointWeight<RealOf<S>>> row) const {
        return transform_of<S>(blended_numbers(prepared, row));
    }

    static constexpr int num_blended = 8;

    /// The dual quaternion before it is normalised.
    Eigen::Matrix<S, num_blended, 1> blended_numbers(const MatrixX<S>& prepared,
                                                     std::span<const JointWeight<RealOf<S>>> row) const {
        using Column = Eigen::Matrix<S, num_blended, 1>;
        SOFTTISSUE_ASSERT(!row.empty());
        JointWeight<RealOf<S>> pivot = row.front();
        for (const JointWeight<RealOf<S>>& entry : row) {
            SOFTTISSUE_ASSERT(entry.joint >= 0 && entry.joint < prepared.cols());
            // no branch: which weight is largest is anybody's guess
            const bool is_pivot =
                (entry.weight > pivot.weight) | ((entry.weight == pivot.weight) & (entry.joint < pivot.joint));
            pivot.joint = is_pivot ? entry.joint : pivot.joint;
            pivot.weight = is_pivot ? entry.weight : pivot.weight;
        }
        Column sum = Column::Zero();
        for (const auto& [joint, weight] : row) {
            const S* const column = prepared.data() + prepared.rows() * Index(joint);
            sum += S(weight) * column[8 + pivot.joint] * Eigen::Map<const Column>(column);
        }
        return sum;
    }

    /// Rotation and translation of (q + eps e) / |q|: R(q / |q|), and the vector part of 2 e conj(q) / |q|^2.
    /// |q| >= largest weight > 0: every aligned quaternion has a non-negative component along the pivot's.
    template <FieldScalar T>
    static AffineTransform<T> transform_of(const Eigen::Matrix<T, num_blended, 1>& numbers) {
        const Quaternion<T> q = numbers.template head<4>(), e = numbers.template tail<4>();
        const T factor = T(2) / T(q.squaredNorm());
        const Quaternion<T> scaled = factor * q;
        const Quaternion<T> conjugate(scaled(0), -scaled(1), -scaled(2), -scaled(3));
        return {rotation_matrix_from_scaled_quaternions(q, scaled),
                quaternion_product(e, conjugate).template tail<3>()};
    }
};

}  // namespace softtissue
