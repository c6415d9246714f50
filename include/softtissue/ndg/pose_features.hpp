// SPDX-License-Identifier: MIT
/// @file
/// What a network sees of a pose.
///
/// What        the local rotations of all joints but the root, flattened. The root is left out: a body that turns as a whole
///             deforms as before, and whoever reads the network's result turns it (see neural_animation.hpp).
/// Shapes      9 (joints - 1) numbers: joints ascending, each R_j row after row (as NumPy and PyTorch flatten it)
/// Refuses     a pose of another skeleton, rotations that are not finite (InvalidInput names the joint), features of
///             another size
/// Source      Nolte et al. 2026, sec. 4.4
/// Departs     the paper lists all joints
/// Tests       tests/unit/ndg/pose_features_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/pose.hpp>

#include <cmath>
#include <span>

namespace softtissue {

inline Index num_pose_features(const KinematicTree& tree) {
    return 9 * (tree.num_joints() - 1);
}

namespace detail {

/// rotation(j) is the local rotation of joint j.
template <RealScalar N, class Rotation>
void rotation_features_into(const KinematicTree& tree, const Rotation& rotation, Eigen::Ref<VectorX<N>> features) {
    require(features.size() == num_pose_features(tree), "pose features: room for ", features.size(),
            " numbers, expected ", num_pose_features(tree));
    Index next = 0;
    for (Index j = 0; j < tree.num_joints(); ++j) {
        const auto R = rotation(j);
        require(R.allFinite(), "pose features: the rotation of joint ", j, " is not finite");
        if (j == tree.root()) {
            continue;
        }
        features.template segment<9>(next) = R.transpose().reshaped().template cast<N>();
        next += 9;
    }
}

}  // namespace detail

/// From local rotation matrices, one per joint; N is the network's scalar.
template <RealScalar N, RealScalar S>
void pose_features_into(const KinematicTree& tree, std::span<const Matrix3<S>> local_rotations,
                        Eigen::Ref<VectorX<N>> features) {
    require(Index(local_rotations.size()) == tree.num_joints(), "pose features: ", local_rotations.size(),
            " joint rotations, expected ", tree.num_joints());
    detail::rotation_features_into<N>(
        tree, [&](Index j) -> Matrix3<S> { return local_rotations[size_t(j)]; }, features);
}

/// From a pose; its root and translation must be finite as well.
template <RealScalar N, RealScalar S>
void pose_features_into(const KinematicTree& tree, const Pose<S>& pose, Eigen::Ref<VectorX<N>> features) {
    require(pose.rotation_vectors.cols() == tree.num_joints(), "pose features: a pose of ",
            pose.rotation_vectors.cols(), " joints, expected ", tree.num_joints());
    require(pose.translation.allFinite(), "pose features: the translation is not finite");
    for (Index j = 0; j < tree.num_joints(); ++j) {
        require(std::isfinite(pose.rotation_vectors.col(j).squaredNorm()),
                "pose features: the rotation vector of joint ", j, " is not finite");
    }
    detail::rotation_features_into<N>(
        tree, [&](Index j) -> Matrix3<S> { return local_rotation(pose, j); }, features);
}

}  // namespace softtissue
