// SPDX-License-Identifier: MIT
/// @file
/// What a skinning policy is: how the transforms of a few weighted joints become one transform of a vertex.
///
/// SkinningPolicy     `using Scalar`, and two const functions:
///   prepare_into(joint_transforms, prepared)   once per pose: writes one column of numbers per joint, in whatever
///                                              form the policy blends; allocates only when the size changes
///   blend(prepared, row)                       once per vertex: the blended transform of a row of (joint, weight)
///
/// PackedSkinningPolicy   a policy that takes many vertices at once where their transforms are not asked for (skin_points.hpp):
///   num_blended, blended_numbers(prepared, row)   the numbers that the transform is made of
///   transform_of<T>(numbers)                      the transform, T a plain number or a pack of them
///                                                 blend(prepared, row) = transform_of(blended_numbers(prepared, row))
///
/// Laws (softtissue/testing/skinning_laws.hpp): the blend of identities is the identity; one transform common to
/// all joints comes back unchanged; a joint of weight one comes back unchanged; the order of a row does not matter;
/// a rigid motion after the joint transforms is a rigid motion after the blend.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <concepts>
#include <span>

namespace softtissue {

template <class P>
concept SkinningPolicy = std::copy_constructible<P> &&
    requires(const P& policy, std::span<const AffineTransform<typename P::Scalar>> joint_transforms,
             MatrixX<typename P::Scalar>& prepared, std::span<const JointWeight<RealOf<typename P::Scalar>>> row) {
    { policy.prepare_into(joint_transforms, prepared) } -> std::same_as<void>;
    { policy.blend(prepared, row) } -> std::same_as<AffineTransform<typename P::Scalar>>;
};

/// So many points at once: sixteen floats cost more to collect than they save.
template <RealScalar S>
inline constexpr int skinning_width = std::min(natural_lanes<S>, 8);

template <RealScalar S>
using SkinningLanes = Pack<S, skinning_width<S>>;

template <class P, class S = typename P::Scalar>
concept PackedSkinningPolicy = SkinningPolicy<P> && RealScalar<S> &&
    requires(const P& policy, const MatrixX<S>& prepared, std::span<const JointWeight<S>> row,
             const Eigen::Matrix<SkinningLanes<S>, P::num_blended, 1>& numbers) {
    { policy.blended_numbers(prepared, row) } -> std::same_as<Eigen::Matrix<S, P::num_blended, 1>>;
    { P::template transform_of<SkinningLanes<S>>(numbers) } -> std::same_as<AffineTransform<SkinningLanes<S>>>;
};

}  // namespace softtissue
