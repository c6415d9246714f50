// SPDX-License-Identifier: MIT
/// @file
/// Forward kinematics: where each joint of a skeleton takes the space around it.
///
/// What        rest-to-posed transform of every joint, posed joint positions.
/// Equation    T_j = T_parent(j) o (rotation R_j about the rest joint c_j):
///             A_j = A_p R_j,  t_j = A_p c_j + t_p - A_j c_j;   above the root: A = I, t = translation of the pose
/// Shapes      joints 3 x num_joints (rest) [m]; pose: see skinning/pose.hpp; one transform per joint.
/// Refuses     joints or pose of another skeleton, a pose that is not finite (InvalidInput names sizes or joint).
/// Source      Loper et al. 2015 (SMPL), eq. (3)-(4): the root turns about its own joint, the translation comes last
/// Cost        one quaternion and one 3x3 product per joint
/// Tests       tests/unit/skinning/joint_transforms_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/pose.hpp>

#include <span>
#include <vector>

namespace softtissue {

/// Rotation of joint `joint` relative to its parent.
template <FieldScalar S>
Matrix3<S> local_rotation(const Pose<S>& pose, Index joint) {
    return rotation_matrix_from_rotation_vector<S>(pose.rotation_vectors.col(joint));
}

/// Writes the rest-to-posed transform of every joint; allocates nothing.
template <FieldScalar S>
void joint_transforms_into(const KinematicTree& tree, const Matrix3X<S>& joints, const Pose<S>& pose,
                           std::span<AffineTransform<S>> transforms) {
    require(joints.cols() == tree.num_joints(), "joint_transforms: ", joints.cols(), " rest joints, expected ",
            tree.num_joints());
    require(pose.rotation_vectors.cols() == tree.num_joints(), "joint_transforms: the pose has ",
            pose.rotation_vectors.cols(), " joints, expected ", tree.num_joints());
    pose.require_finite("joint_transforms");
    SOFTTISSUE_ASSERT(Index(transforms.size()) == tree.num_joints());
    for (const std::int32_t j : tree.order()) {
        AffineTransform<S> parent;
        if (tree.parent(j) == KinematicTree::no_parent) {
            parent.translation = pose.translation;
        } else {
            parent = transforms[size_t(tree.parent(j))];
        }
        AffineTransform<S>& T = transforms[size_t(j)];
        T.linear.noalias() = parent.linear * local_rotation(pose, j);
        T.translation = parent(joints.col(j)) - T.linear * joints.col(j);
    }
}

/// The rest-to-posed transform of every joint.
template <FieldScalar S>
std::vector<AffineTransform<S>> joint_transforms(const KinematicTree& tree, const Matrix3X<S>& joints,
                                                 const Pose<S>& pose) {
    std::vector<AffineTransform<S>> transforms(size_t(tree.num_joints()));
    joint_transforms_into<S>(tree, joints, pose, transforms);
    return transforms;
}

/// Where the joints are after posing, 3 x num_joints [m].
template <FieldScalar S>
Matrix3X<S> posed_joints(const std::vector<AffineTransform<S>>& transforms, const Matrix3X<S>& joints) {
    require(Index(transforms.size()) == joints.cols(), "posed_joints: ", transforms.size(), " transforms, expected ",
            joints.cols());
    Matrix3X<S> result(3, joints.cols());
    for (Index j = 0; j < joints.cols(); ++j) {
        result.col(j) = transforms[size_t(j)](joints.col(j));
    }
    return result;
}

}  // namespace softtissue
