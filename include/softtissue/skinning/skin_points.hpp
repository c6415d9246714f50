// SPDX-License-Identifier: MIT
/// @file
/// Many points by one skinning policy.
///
/// What        skin_points_into(): every point by the blend of its row of weights
/// Equation    x_v = A_v X_v + t_v, (A_v, t_v) the policy's blend of the joint transforms with row v of the weights
/// Shapes      rest, x 3 x points [m]; one row of weights per point
/// Refuses     weights of another number of points, a joint transform that is not finite (InvalidInput names the joint)
/// Packs       the transforms of a PackedSkinningPolicy are made for eight points at once: equal to blend() up to rounding
/// Cost        that of the blends; same bits for every executor. Allocates on the first call only.
/// Tests       tests/unit/skinning/skin_points_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/concepts.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

namespace softtissue {

namespace detail {

/// Points `begin` to `end`, some at once.
template <PackedSkinningPolicy Policy, class S = typename Policy::Scalar>
void skin_packs(const Policy& policy, const MatrixX<S>& prepared, const SkinningWeights<S>& weights,
                const Matrix3X<S>& rest, Index begin, Index end, Matrix3X<S>& x) {
    using Lanes = SkinningLanes<S>;
    constexpr int width = skinning_width<S>;
    constexpr int count = Policy::num_blended;
    std::array<Eigen::Matrix<S, count, 1>, size_t(width)> numbers;
    numbers.fill(Eigen::Matrix<S, count, 1>::Ones());
    for (Index first = begin; first < end; first += width) {
        const int filled = int(std::min(Index(width), end - first));
        for (int i = 0; i < filled; ++i) {
            numbers[size_t(i)] = policy.blended_numbers(prepared, weights.row(first + i));
        }
        Eigen::Matrix<Lanes, count, 1> packed;
        for (int k = 0; k < count; ++k) {
            packed(k) = Lanes::from_lanes([&](int i) { return numbers[size_t(i)](k); });
        }
        const auto point = [&](int i) -> Index { return first + std::min(i, filled - 1); };
        Vector3<Lanes> X;
        for (int d = 0; d < 3; ++d) {
            X(d) = Lanes::from_lanes([&](int i) { return rest(d, point(i)); });
        }
        const Vector3<Lanes> moved = Policy::template transform_of<Lanes>(packed)(X);
        for (int i = 0; i < filled; ++i) {
            for (int d = 0; d < 3; ++d) {
                x(d, first + i) = moved(d)[i];
            }
        }
    }
}

}  // namespace detail

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
        if constexpr (PackedSkinningPolicy<Policy>) {
            detail::skin_packs(policy, prepared, weights, rest, begin, end, x);
        } else {
            for (Index v = begin; v < end; ++v) {
                x.col(v) = policy.blend(prepared, weights.row(v))(rest.col(v));
            }
        }
    });
}

}  // namespace softtissue
