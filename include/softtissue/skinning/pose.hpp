// SPDX-License-Identifier: MIT
/// @file
/// One pose of a skeleton as SMPL and AMASS store it.
///
/// What        local rotation of each joint relative to its parent, and a translation added after posing.
/// Shapes      rotation_vectors 3 x joints [rad] (axis times angle), translation 3 [m].
/// Refuses     require_finite(): a number that is not finite, a rotation whose squared length is not (InvalidInput names the joint)
/// Source      Loper et al. 2015 (SMPL), sec. 3; Romero et al. 2020, sec. 3.1.
/// Tests       tests/unit/skinning/pose_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>
#include <string_view>

namespace softtissue {

template <FieldScalar S>
struct Pose {
    using Scalar = S;

    Matrix3X<Scalar> rotation_vectors;
    Vector3<Scalar> translation = Vector3<Scalar>::Zero();

    /// The rest pose of `num_joints` joints.
    static Pose rest(Index num_joints) { return {Matrix3X<Scalar>::Zero(3, num_joints), Vector3<Scalar>::Zero()}; }

    /// Throws InvalidInput unless every joint turns by a finite angle and the translation is finite; `source` starts the message.
    void require_finite(std::string_view source) const {
        for (Index j = 0; j < rotation_vectors.cols(); ++j) {
            const Scalar squared = rotation_vectors.col(j).squaredNorm();
            require(std::isfinite(value_of(squared)), source, ": joint ", j, ": rotation is not finite");
        }
        for (int d = 0; d < 3; ++d) {
            require(std::isfinite(value_of(translation(d))), source, ": translation is not finite");
        }
    }
};

}  // namespace softtissue
