// SPDX-License-Identifier: MIT
/// @file
/// Thickness of the fat below each vertex of the skin.
///
/// What        fat_thickness(): a table per joint, blended by the skinning weights, grown with the body's corpulence.
/// Equation    f_i = h sum_j w_ij (fat_j + buttock_i [j = bottom of the trunk]) c_j,  not below `thinnest`;
///             c_j = (mean over the skin of joint j of |s_i - T_i| / (h depth_j))^2,  bounded by [1/2, 3]:
///             what a body has between skin and bones beyond the reference is taken for fat first.
/// Shapes      skin, targets 3 x n [m], weights num_joints x n; one thickness per vertex [m].
/// Valid       a plausible distribution, not a measurement of a person; h: scale of the skeleton.
/// Tests       tests/unit/anatomy/fat_thickness_test.cpp
#pragma once

#include <softtissue/anatomy/body_anatomy.hpp>
#include <softtissue/anatomy/bone_targets.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>

namespace softtissue {

/// c_j of every joint: how much more fat than the reference its part of the body carries.
template <RealScalar S>
VectorX<S> corpulence(const BodyAnatomy& anatomy, S scale, const VectorX<S>& depth, const MatrixX<S>& weights) {
    VectorX<S> factor = VectorX<S>::Ones(weights.rows());
    for (Index j = 0; j < weights.rows(); ++j) {
        const S area = weights.row(j).sum();
        if (area > S(0)) {
            const S ratio = weights.row(j).dot(depth) / (area * scale * S(anatomy.depth[size_t(j)]));
            factor(j) = std::clamp(ratio * ratio, S(0.5), S(3));
        }
    }
    return factor;
}

/// See the file comment.
template <RealScalar S>
VectorX<S> fat_thickness(const BodyAnatomy& anatomy, const BoneTargets<S>& bones, const Matrix3X<S>& skin,
                         const Matrix3X<S>& targets, const MatrixX<S>& weights, S thinnest) {
    const VectorX<S> depth = (skin - targets).colwise().norm().transpose();
    const VectorX<S> factor = corpulence<S>(anatomy, bones.scale(), depth, weights);
    VectorX<S> thickness(skin.cols());
    for (Index v = 0; v < skin.cols(); ++v) {
        S sum(0);
        for (Index j = 0; j < weights.rows(); ++j) {
            S fat = S(anatomy.fat[size_t(j)]);
            if (j == anatomy.trunk.bottom) {
                const S backward = std::max(bones.trunk().backward(skin.col(v)), S(0));
                fat += S(anatomy.trunk.buttock_fat) * backward * backward;
            }
            sum += weights(j, v) * fat * factor(j);
        }
        thickness(v) = std::max(bones.scale() * sum, thinnest);
    }
    return thickness;
}

}  // namespace softtissue
