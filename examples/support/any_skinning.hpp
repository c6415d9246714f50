// SPDX-License-Identifier: MIT
/// @file
/// A skinning policy chosen while the program runs.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <span>
#include <variant>

namespace examples {

/// Satisfies softtissue::SkinningPolicy by asking whichever policy it holds.
template <class S>
struct AnySkinning {
    using Scalar = S;
    std::variant<softtissue::LinearBlend<S>, softtissue::DualQuaternion<S>> policy;

    void prepare_into(std::span<const softtissue::AffineTransform<S>> joint_transforms,
                      softtissue::MatrixX<S>& prepared) const {
        std::visit([&](const auto& p) { p.prepare_into(joint_transforms, prepared); }, policy);
    }
    softtissue::AffineTransform<S> blend(const softtissue::MatrixX<S>& prepared,
                                         std::span<const softtissue::JointWeight<S>> row) const {
        return std::visit([&](const auto& p) { return p.blend(prepared, row); }, policy);
    }
};

}  // namespace examples
