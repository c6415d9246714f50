// SPDX-License-Identifier: MIT
/// @file
/// A body in one pose: where every vertex is, and the transform that took it there.
///
/// What        the result of VolumetricSmpl::pose, the input of inverse skinning and of the unposed strain frame.
/// Equation    positions_i = A_i (rest_i + offsets_i) + t_i
/// Shapes      transforms one (A_i, t_i) per vertex; offsets (pose blend shapes, in rest space), positions
///             3 x vertices [m]; joint_transforms one per joint, rest to posed.
///             pose_features 9 (joints - 1), prepared_joints as the skinning policy states: kept here so that a
///             body posed again and again allocates once.
/// Source      Romero et al. 2020, sec. 3.4
/// Tests       tests/unit/skinning/posed_body_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/affine_transform.hpp>

#include <vector>

namespace softtissue {

template <RealScalar S>
struct PosedBody {
    using Scalar = S;

    std::vector<AffineTransform<Scalar>> transforms;
    Matrix3X<Scalar> offsets;
    Matrix3X<Scalar> positions;

    std::vector<AffineTransform<Scalar>> joint_transforms;
    VectorX<Scalar> pose_features;
    MatrixX<Scalar> prepared_joints;

    Index num_vertices() const { return positions.cols(); }

    /// Takes the sizes of a body; does nothing where they are right already.
    void resize(Index num_vertices, Index num_joints) {
        transforms.resize(size_t(num_vertices));
        offsets.resize(3, num_vertices);
        positions.resize(3, num_vertices);
        joint_transforms.resize(size_t(num_joints));
        pose_features.resize(9 * (num_joints - 1));
    }
};

}  // namespace softtissue
