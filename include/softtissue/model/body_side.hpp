// SPDX-License-Identifier: MIT
/// @file
/// One half of a body, seen as the left one: where its bone wrap and muscle wrap lie around the bones.
///
/// What        BodySide: joints and wraps of the left half, or of the right half mirrored at x = 0, so that what is made
///             for the left serves both. BodyChart: coordinates (t, angle, radius) around a limb segment or the trunk.
/// Equation    limb: origin(t) = a + t (b - a); trunk: t = height from pelvis (0) to neck (1), origin in the middle between
///             front and back of the bone wrap. direction(angle) = cos(angle) front + sin(angle) side, across the axis; 0 is the front, 90
///             degrees the outer side (the upper one of an arm held sideways), 180 the back.
///             point(t, angle, f) = origin + ((1 - f) bone + f muscle) direction, with the distances of the two wraps.
/// Shapes      SMPL's 24 joints, y up, facing +z, left = +x; wraps as RayDistance. Lengths in metres.
/// Valid       rays that leave through a cut or into the next part of the body stop at `reach`.
/// Tests       tests/unit/model/body_side_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/ray_distance.hpp>
#include <softtissue/model/human_solid.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace softtissue {

class BodySide {
public:
    /// `bone` and `muscle` must outlive this object.
    BodySide(const Matrix3X<double>& joints, const RayDistance<double>& bone, const RayDistance<double>& muscle,
             bool is_right)
        : joints_(joints), bone_(bone), muscle_(muscle), is_right_(is_right) {
        if (is_right) {
            for (Index j = 0; j < joints.cols(); ++j) {
                joints_.col(j) = mirrored(joints.col(mirror_joint(j)));
            }
        }
    }

    Vector3<double> joint(Index j) const { return joints_.col(j); }
    bool is_right() const { return is_right_; }

    double bone_distance(const Vector3<double>& origin, const Vector3<double>& direction) const {
        return is_right_ ? bone_(mirrored(origin), mirrored(direction)) : bone_(origin, direction);
    }
    double muscle_distance(const Vector3<double>& origin, const Vector3<double>& direction) const {
        return is_right_ ? muscle_(mirrored(origin), mirrored(direction)) : muscle_(origin, direction);
    }

    /// `point`, or where the way there from `inside` comes within `margin` of the bone wrap, or half as near as `inside` is.
    Vector3<double> within_bone(const Vector3<double>& inside, const Vector3<double>& point, double margin) const {
        const Vector3<double> way = point - inside;
        const double length = way.norm();
        if (length == 0.0) {
            return point;
        }
        const double distance = bone_distance(inside, way / length);
        const double limit = std::max(0.5 * distance, distance - margin);
        return length <= limit ? point : Vector3<double>(inside + limit / length * way);
    }

private:
    Matrix3X<double> joints_;
    const RayDistance<double>& bone_;
    const RayDistance<double>& muscle_;
    bool is_right_;
};

class BodyChart {
public:
    /// Around the segment from joint a to joint b; t = 1 is joint b, or the cut if the wraps end before.
    static BodyChart limb(const BodySide& body, Index a, Index b, double reach) {
        const Vector3<double> start = body.joint(a);
        const Vector3<double> axis = body.joint(b) - start;
        BodyChart chart(body, {start, start + axis}, {0.0, 1.0}, axis.norm(), axis.normalized(), reach);
        chart.stop_at_cut(0.5, 1.0);
        return chart;
    }

    /// Around the spine, through the middle of the bone wrap in the body's mid-plane; directions are level.
    static BodyChart trunk(const BodySide& body, double reach) {
        const Vector3<double> bottom(0.0, body.joint(human_joint::pelvis)(1), body.joint(human_joint::pelvis)(2));
        const double length = body.joint(human_joint::neck)(1) - bottom(1);
        const Vector3<double> z = Vector3<double>::UnitZ();
        std::vector<Vector3<double>> chain;
        std::vector<double> heights;
        for (double t = -0.3; t < 1.3; t += 0.05) {
            const Vector3<double> x = bottom + t * length * Vector3<double>::UnitY();
            const double front = outside - body.bone_distance(x + outside * z, -z);
            const double back = outside - body.bone_distance(x - outside * z, z);
            if (front + back > 0.0) {  // neither misses
                chain.push_back(x + 0.5 * (front - back) * z);
                heights.push_back(t);
            }
        }
        if (chain.empty()) {
            chain = {bottom, bottom + length * Vector3<double>::UnitY()};
            heights = {0.0, 1.0};
        }
        BodyChart chart(body, std::move(chain), std::move(heights), length, Vector3<double>::UnitY(), reach);
        chart.side_ = Vector3<double>::UnitX();
        chart.stop_at_cut(0.85, 1.16);
        return chart;
    }

    /// From t = 0 to t = 1 [m].
    double length() const { return length_; }
    const Vector3<double>& front() const { return front_; }
    const Vector3<double>& side() const { return side_; }

    Vector3<double> origin(double t) const {
        if (t > soft_from_) {
            t = soft_from_ + (t - soft_from_) * stretch_;
        }
        size_t k = 0;
        while (k + 2 < chain_.size() && t > heights_[k + 1]) {
            ++k;
        }
        const double s = (t - heights_[k]) / (heights_[k + 1] - heights_[k]);
        // Beyond the ends straight on along the axis.
        const double inside = std::clamp(s, 0.0, 1.0);
        return chain_[k] + inside * (chain_[k + 1] - chain_[k]) +
               (s - inside) * (heights_[k + 1] - heights_[k]) * length_ * along_;
    }

    /// Angles in degrees.
    Vector3<double> direction(double angle) const {
        const double radians = angle * std::numbers::pi / 180.0;
        return std::cos(radians) * front_ + std::sin(radians) * side_;
    }

    /// Distances of bone wrap and muscle wrap from the axis; the first is the smaller.
    std::array<double, 2> wraps(double t, double angle) const {
        const Vector3<double> o = origin(t);
        const Vector3<double> d = direction(angle);
        const double muscle = std::min(body_->muscle_distance(o, d), reach_);
        const double bone = body_->bone_distance(o, d);
        // Without a bone wrap on the way, or behind the muscle wrap: a slim share.
        return {bone < muscle ? bone : 0.6 * muscle, muscle};
    }

    Vector3<double> point(double t, double angle, double f) const {
        const auto [bone, muscle] = wraps(t, angle);
        return origin(t) + ((1.0 - f) * bone + f * muscle) * direction(angle);
    }

private:
    static constexpr double outside = 1.0;  // farther than any wrap from its axis [m]

    BodyChart(const BodySide& body, std::vector<Vector3<double>> chain, std::vector<double> heights, double length,
              const Vector3<double>& along, double reach)
        : body_(&body),
          chain_(std::move(chain)),
          heights_(std::move(heights)),
          along_(along),
          length_(length),
          reach_(reach) {
        front_ = (Vector3<double>::UnitZ() - along(2) * along).normalized();
        side_ = front_.cross(along_);
    }

    /// Shortens what lies above `from` so that `last` comes to lie where the wraps still surround the axis.
    void stop_at_cut(double from, double last) {
        double t = last;
        const auto is_surrounded = [this](double place) {
            for (double angle = 0.0; angle < 360.0; angle += 30.0) {
                const Vector3<double> o = origin(place);
                const double farthest =
                    std::max(body_->bone_distance(o, direction(angle)), body_->muscle_distance(o, direction(angle)));
                if (!(farthest < reach_)) {
                    return false;
                }
            }
            return true;
        };
        while (t > from && !is_surrounded(t)) {
            t -= 0.01;
        }
        soft_from_ = from;
        // Without a wrap as far as `from` nothing says where to stop.
        stretch_ = t > from ? (t - from) / (last - from) : 1.0;
    }

    const BodySide* body_;
    std::vector<Vector3<double>> chain_;
    std::vector<double> heights_;
    Vector3<double> along_;
    Vector3<double> front_;
    Vector3<double> side_;
    double length_;
    double reach_;
    double soft_from_ = 1e9;
    double stretch_ = 1.0;
};

}  // namespace softtissue
