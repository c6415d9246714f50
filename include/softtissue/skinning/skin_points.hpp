// SPDX-License-Identifier: MIT
/// @file
/// Many points by one skinning policy.
///
/// What        skin_points_into(): every point by the blend of its row of weights
/// Equation    x_v = A_v X_v + t_v, (A_v, t_v) the policy's blend of the joint transforms with row v of the weights
/// Shapes      rest, x 3 x points [m]; one row of weights per point
/// Refuses     weights of another number of points, a joint transform that is not finite (InvalidInput names the joint)
/// Cost        that of the blends; same bits for every executor. Allocates on the first call only.
/// Tests       tests/unit/skinning/skin_points_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/concepts.hpp>
#include <softtissue/skinning/weights.hpp>

#include <span>
#include <type_traits>

namespace softtissue {

/// `prepared` is the policy's memory (see SkinningPolicy), kept by the caller between frames.
template <SkinningPolicy Policy, class S = typename Policy::Scalar, Executor E = SequentialExecutor>
void skin_points_into(const Policy& policy, std::type_identity_t<std::span<const AffineTransform<S>>> joint_transforms,
                      const SkinningWeights<RealOf<S>>& weights, const Matrix3X<S>& rest, MatrixX<S>& prepared,
                      Matrix3X<S>& x, const E& executor = {}) {
    require(weights.num_vertices() == rest.cols(), "skinning: weights of ", weights.num_vertices(),
            " points, expected ", rest.cols());
    for (size_t j = 0; j < joint_transforms.size(); ++j) {
        require(joint_transforms[j].is_finite(), "skinning: transform of joint ", j, " is not finite");
    }
    policy.prepare_into(joint_transforms, prepared);
    x.resize(3, rest.cols());
    executor.for_each_range(x.cols(), [&](Index begin, Index end) {
        for (Index v = begin; v < end; ++v) {
            x.col(v) = policy.blend(prepared, weights.row(v))(rest.col(v));
        }
    });
}

}  // namespace softtissue
