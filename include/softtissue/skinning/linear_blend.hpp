// SPDX-License-Identifier: MIT
/// @file
/// Linear blend skinning: the weighted mean of the joint transforms.
///
/// What        a SkinningPolicy.
/// Equation    (A, t) = sum_j w_j (A_j, t_j)
/// Shapes      prepared: 12 x joints, column j = (vec A_j, t_j).
/// Valid       any affine joint transforms. The blend of rotations is not a rotation: it shrinks, and is near
///             singular where joints of similar weight differ by nearly pi (skinning/inverse.hpp detects it).
/// Source      Magnenat-Thalmann et al. 1988; Loper et al. 2015 (SMPL), eq. (2)
/// Cost        24 flop per influence
/// Tests       tests/unit/skinning/linear_blend_test.cpp, laws: tests/laws/skinning_laws_test.cpp
#pragma once

#include <softtissue/skinning/concepts.hpp>

#include <softtissue/core/config.hpp>

namespace softtissue {

template <FieldScalar S>
struct LinearBlend {
    using Scalar = S;

    void prepare_into(std::span<const AffineTransform<S>> joint_transforms, MatrixX<S>& prepared) const {
        prepared.resize(12, Index(joint_transforms.size()));
        for (Index j = 0; j < prepared.cols(); ++j) {
            const AffineTransform<S>& T = joint_transforms[size_t(j)];
            prepared.col(j) << T.linear.col(0), T.linear.col(1), T.linear.col(2), T.translation;
        }
    }

    AffineTransform<S> blend(const MatrixX<S>& prepared, std::span<const JointWeight<RealOf<S>>> row) const {
        using Column = Eigen::Matrix<S, 12, 1>;
        Column sum = Column::Zero();
        for (const auto& [joint, weight] : row) {
            SOFTTISSUE_ASSERT(joint >= 0 && joint < prepared.cols());
            sum += S(weight) * Eigen::Map<const Column>(prepared.data() + 12 * Index(joint));
        }
        return {Eigen::Map<const Matrix3<S>>(sum.data()), sum.template tail<3>()};
    }
};

}  // namespace softtissue
