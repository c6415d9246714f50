// SPDX-License-Identifier: MIT
/// @file
/// The rotation that a few bones, blended, give to a vertex or a cell.
///
/// What        R_p of Neural Deformation Gradients and Gradient Skinning; one rotation per row of weights.
/// Equation    q_p = sum_b w_b s_b q_b / |.|,  b over the max_blended_bones largest weights, s_b = sign(q_b . q_1)
/// Shapes      bone quaternions (w, x, y, z), one per joint; result one 3x3 rotation per row.
/// Valid       every row: |sum| is at least the largest weight. Continuous in the pose except where a bone and the
///             one of largest weight differ by exactly pi.
/// Refuses     BlendedRotations: bones or rotations of another number, a bone that is not finite (InvalidInput names it)
/// Source      Nolte et al. 2026, eq. (11); Kavan et al. 2008
/// Cost        8 flop per bone, 30 flop and a square root per row
/// Tests       tests/unit/skinning/blended_rotation_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace softtissue {

inline constexpr size_t max_blended_bones = 8;

/// The unit quaternion of a row that starts with its largest weight.
template <FieldScalar S>
Quaternion<S> blended_quaternion(std::span<const Quaternion<S>> bones, std::span<const JointWeight<RealOf<S>>> row) {
    using std::sqrt;
    SOFTTISSUE_ASSERT(!row.empty());
    const Quaternion<S>& pivot = bones[size_t(row.front().joint)];
    Quaternion<S> sum = Quaternion<S>::Zero();
    for (const auto& [joint, weight] : row) {
        sum += S(weight) * aligned_quaternion(bones[size_t(joint)], pivot);
    }
    return sum / S(sqrt(sum.squaredNorm()));
}

/// Rotations of joint transforms as unit quaternions.
template <FieldScalar S>
void bone_quaternions_into(std::span<const AffineTransform<S>> joint_transforms, std::vector<Quaternion<S>>& bones) {
    bones.resize(joint_transforms.size());
    for (size_t j = 0; j < bones.size(); ++j) {
        bones[j] = quaternion_from_rotation_matrix(joint_transforms[j].linear);
    }
}

template <FieldScalar S>
std::vector<Quaternion<S>> bone_quaternions(std::span<const AffineTransform<S>> joint_transforms) {
    std::vector<Quaternion<S>> bones;
    bone_quaternions_into(joint_transforms, bones);
    return bones;
}

/// The rows of skinning weights, of vertices or of cells, cut to their largest and ordered for blending.
template <RealScalar S>
class BlendedRotations {
public:
    explicit BlendedRotations(const SkinningWeights<S>& weights) : num_joints_(weights.num_joints()) {
        for (Index r = 0; r < weights.num_vertices(); ++r) {
            std::vector<JointWeight<S>> row(weights.row(r).begin(), weights.row(r).end());
            std::stable_sort(row.begin(), row.end(),
                             [](const JointWeight<S>& a, const JointWeight<S>& b) { return a.weight > b.weight; });
            row.resize(std::min(row.size(), max_blended_bones));
            entries_.insert(entries_.end(), row.begin(), row.end());
            offsets_.push_back(entries_.size());
        }
    }

    Index num_rows() const { return Index(offsets_.size()) - 1; }
    Index num_joints() const { return num_joints_; }

    /// The blended bones, largest weight first; equal weights by joint.
    std::span<const JointWeight<S>> row(Index r) const {
        return {entries_.data() + offsets_[size_t(r)], entries_.data() + offsets_[size_t(r) + 1]};
    }

    /// Throws InvalidInput unless there is a quaternion for every joint, without NaN or infinity.
    void require_bones(std::span<const Quaternion<S>> bones) const {
        require(Index(bones.size()) == num_joints_, "blended rotations: ", bones.size(), " bones, expected ",
                num_joints_);
        for (size_t j = 0; j < bones.size(); ++j) {
            require(bones[j].allFinite(), "blended rotations: quaternion of joint ", j, " is not finite");
        }
    }

    /// Writes one rotation per row; allocates nothing. Same bits for every executor.
    template <Executor Exec = SequentialExecutor>
    void rotations_into(std::span<const Quaternion<S>> bones, std::span<Matrix3<S>> rotations,
                        const Exec& executor = {}) const {
        require_bones(bones);
        require(Index(rotations.size()) == num_rows(), "blended rotations: ", rotations.size(), " rotations, expected ",
                num_rows());
        executor.for_each_range(num_rows(), [&](Index begin, Index end) {
            for (Index r = begin; r < end; ++r) {
                rotations[size_t(r)] = rotation_matrix_from_quaternion(blended_quaternion<S>(bones, row(r)));
            }
        });
    }

    /// One rotation per row.
    std::vector<Matrix3<S>> rotations(std::span<const AffineTransform<S>> joint_transforms) const {
        std::vector<Matrix3<S>> result(offsets_.size() - 1);
        rotations_into(bone_quaternions(joint_transforms), result);
        return result;
    }

private:
    Index num_joints_;
    std::vector<size_t> offsets_{0};
    std::vector<JointWeight<S>> entries_;
};

}  // namespace softtissue
