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

template <class P>
concept PackedSkinningPolicy = SkinningPolicy<P> && RealScalar<typename P::Scalar> && requires(
    const P& policy, const MatrixX<typename P::Scalar>& prepared,
    std::span<const JointWeight<RealOf<typename P::Scalar>>> row,
    const Eigen::Matrix<Pack<typename P::Scalar, natural_lanes<typename P::Scalar>>, P::num_blended, 1>& packed) {
    { policy.blended_numbers(prepared, row) } -> std::same_as<Eigen::Matrix<typename P::Scalar, P::num_blended, 1>>;
    {
        P::template transform_of<Pack<typename P::Scalar, natural_lanes<typename P::Scalar>>>(packed)
        } -> std::same_as<AffineTransform<Pack<typename P::Scalar, natural_lanes<typename P::Scalar>>>>;
};

}  // namespace softtissue
