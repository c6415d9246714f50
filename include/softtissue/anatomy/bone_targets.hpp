// SPDX-License-Identifier: MIT
/// @file
/// Where the bone wrap should lie below each vertex of the skin.
///
/// What        BoneTargets: the wanted points of the bone wrap, one below each skin vertex.
/// Equation    T(s) = sum_g w_g b_g(s) / sum_g w_g, the bones g weighted by the (smoothed) skinning weights of their joints;
///             limb:  b = a + (s - a) min(rho(t) / |s - a|, cap),  a the closest point of the bone's segment;
///             trunk: b = c + (s - c) min(1 / k, cap),  c the middle of the trunk's skin at the height of s, k the elliptic
///             radius |((s - c)_width / W(t), (s - c)_depth / D(t))|.
/// Shapes      skin 3 x n [m], joints 3 x num_joints [m], weights num_joints x n.
/// Valid       `cap` < 1 keeps every target inside the skin, seen from its bone; whether prisms between are valid is a
///             question of the whole surface, see project_targets() and flow_to_targets().
/// Refuses     joints whose trunk has no length or no width (InvalidInput).
/// Tests       tests/unit/anatomy/bone_targets_test.cpp
#pragma once

#include <softtissue/anatomy/body_anatomy.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace softtissue {

/// The trunk's frame, the middle line of its skin, and the tube around it.
template <RealScalar S>
class TrunkTube {
public:
    TrunkTube(const TrunkShape& shape, S scale, const Matrix3X<S>& joints, const Matrix3X<S>& skin,
              const MatrixX<S>& weights)
        : shape_(shape), scale_(scale), origin_(joints.col(shape.bottom)) {
        const Vector3<S> axis = joints.col(shape.top) - origin_;
        length_ = axis.norm();
        require(length_ > S(0), "layered body: joints ", shape.bottom, " and ", shape.top,
                " of the trunk coincide, expected a distance > 0");
        up_ = axis / length_;
        const Vector3<S> across = joints.col(shape.left) - joints.col(shape.right);
        left_ = across - up_ * up_.dot(across);
        require(left_.norm() > S(1e-3) * length_, "layered body: joints ", shape.left, " and ", shape.right,
                " lie along the trunk, expected a direction across");
        left_.normalize();
        front_ = left_.cross(up_);
        find_middles(skin, weights);
    }

    /// 0 at the bottom joint, 1 at the top joint.
    S height(const Vector3<S>& point) const { return up_.dot(point - origin_) / length_; }

    /// The cosine of the way from the middle to `point` with the direction backwards.
    S backward(const Vector3<S>& point) const {
        const Vector3<S> out = point - middle(height(point));
        return -front_.dot(out) / (out.norm() + std::numeric_limits<S>::min());
    }

    Vector3<S> target(const Vector3<S>& point) const {
        using std::sqrt;
        const S t = height(point);
        const Vector3<S> centre = middle(std::max(t, S(shape_.lowest)));
        const Vector3<S> out = point - centre;
        const S x = left_.dot(out) / (scale_ * S(shape_.half_width(double(t))));
        const S z = front_.dot(out) / (scale_ * S(shape_.half_depth(double(t))));
        const S y = up_.dot(out) / (scale_ * S(shape_.floor_depth));
        const S radius = sqrt(x * x + y * y + z * z);
        return centre + out * std::min(S(1) / radius, S(shape_.cap));
    }

private:
    static constexpr Index num_bins = 32;

    /// The middle between the foremost and the rearmost trunk vertex in each slice of the height.
    void find_middles(const Matrix3X<S>& skin, const MatrixX<S>& weights) {
        std::vector<Index> members;
        lowest_ = std::numeric_limits<S>::infinity();
        S highest = -lowest_;
        for (Index v = 0; v < skin.cols(); ++v) {
            S weight(0);
            for (const std::int32_t joint : shape_.joints) {
                weight += weights(joint, v);
            }
            if (weight > S(0.5)) {
                members.push_back(v);
                lowest_ = std::min(lowest_, height(skin.col(v)));
                highest = std::max(highest, height(skin.col(v)));
            }
        }
        if (members.empty()) {  // nothing will ask for the trunk; its joints stand for the middle
            lowest_ = S(0);
            highest = S(1);
        }
        bin_height_ = std::max((highest - lowest_) / S(num_bins), S(1e-6));
        std::vector<S> rear(size_t(num_bins), std::numeric_limits<S>::infinity());
        std::vector<S> fore(size_t(num_bins), -std::numeric_limits<S>::infinity());
        for (const Index v : members) {
            const S bin = (height(skin.col(v)) - lowest_) / bin_height_;
            const size_t b = std::min(size_t(bin), size_t(num_bins - 1));
            const S z = front_.dot(skin.col(v) - origin_);
            rear[b] = std::min(rear[b], z);
            fore[b] = std::max(fore[b], z);
        }
        middles_ = VectorX<S>::Zero(num_bins);
        Index filled = -1;
        for (Index b = 0; b < num_bins; ++b) {
            if (!(rear[size_t(b)] <= fore[size_t(b)])) {
                continue;
            }
            middles_(b) = (rear[size_t(b)] + fore[size_t(b)]) / S(2);
            for (Index gap = filled + 1; gap < b; ++gap) {  // empty slices interpolate
                const S s = S(gap - filled) / S(b - filled);
                middles_(gap) = filled < 0 ? middles_(b) : middles_(filled) + s * (middles_(b) - middles_(filled));
            }
            filled = b;
        }
        for (Index gap = filled + 1; filled >= 0 && gap < num_bins; ++gap) {
            middles_(gap) = middles_(filled);
        }
    }

    Vector3<S> middle(S t) const {
        const S bin = std::clamp((t - lowest_) / bin_height_ - S(0.5), S(0), S(num_bins - 1));
        const Index below = std::min(static_cast<Index>(bin), num_bins - 2);
        const S s = bin - S(below);
        const S z = (S(1) - s) * middles_(below) + s * middles_(below + 1);
        return origin_ + up_ * (t * length_) + front_ * z;
    }

    const TrunkShape& shape_;
    S scale_;
    Vector3<S> origin_;
    Vector3<S> up_;
    Vector3<S> left_;
    Vector3<S> front_;
    S length_;
    S lowest_;
    S bin_height_;
    VectorX<S> middles_;
};

/// Holds references to the anatomy.
template <RealScalar S>
class BoneTargets {
public:
    BoneTargets(const BodyAnatomy& anatomy, const Matrix3X<S>& joints, const Matrix3X<S>& skin,
                const MatrixX<S>& weights)
        : anatomy_(anatomy),
          joints_(joints),
          weights_(weights),
          scale_(anatomy.scale(joints)),
          trunk_(anatomy.trunk, scale_, joints, skin, weights) {}

    /// Size of the skeleton relative to the anatomy's.
    S scale() const { return scale_; }
    const TrunkTube<S>& trunk() const { return trunk_; }

    /// T(point), with the weights of `vertex`.
    Vector3<S> target(Index vertex, const Vector3<S>& point) const {
        S sum = joint_weight(anatomy_.trunk.joints, vertex);
        Vector3<S> blend = sum > S(0) ? (sum * trunk_.target(point)).eval() : Vector3<S>::Zero();
        for (const LimbBone& bone : anatomy_.limbs) {
            const S weight = joint_weight(bone.joints, vertex);
            if (weight > S(0)) {
                blend += weight * limb_target(bone, point);
                sum += weight;
            }
        }
        return blend / sum;
    }

    /// T of every vertex, 3 x n.
    Matrix3X<S> targets(const Matrix3X<S>& skin) const {
        Matrix3X<S> result(3, skin.cols());
        for (Index v = 0; v < skin.cols(); ++v) {
            result.col(v) = target(v, skin.col(v));
        }
        return result;
    }

private:
    S joint_weight(const std::vector<std::int32_t>& joints, Index vertex) const {
        S sum(0);
        for (const std::int32_t joint : joints) {
            sum += weights_(joint, vertex);
        }
        return sum;
    }

    Vector3<S> limb_target(const LimbBone& bone, const Vector3<S>& point) const {
        const Vector3<S> start = joints_.col(bone.start);
        const Vector3<S> axis = joints_.col(bone.end) - start;
        const S t =
            std::clamp(axis.dot(point - start) / (axis.squaredNorm() + std::numeric_limits<S>::min()), S(0), S(1));
        const Vector3<S> foot = start + t * axis;
        const Vector3<S> out = point - foot;
        return foot + out * std::min(scale_ * S(bone.radius(double(t))) / out.norm(), S(bone.cap));
    }

    const BodyAnatomy& anatomy_;
    const Matrix3X<S>& joints_;
    const MatrixX<S>& weights_;
    S scale_;
    TrunkTube<S> trunk_;
};

}  // namespace softtissue
