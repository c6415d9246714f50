// SPDX-License-Identifier: MIT
/// @file
/// What procedural bones are made of: tubes, shafts, bulbs and plates that stay within the bone wrap.
///
/// What        BoneLofts: adds closed pieces to the bone begun last; the chest's ellipse for what curves around the trunk.
/// Method      lofts of elliptic rings along stations, in mm of an adult with SMPL's reference skeleton, times `scale`; what
///             would leave the bone wrap is drawn back towards its own axis.
/// Shapes      AnatomyMesh<double>, left half (BodySide).
/// Source      a design after anatomical plates: suggestive, not measured.
/// Tests       tests/unit/model/bone_lofts_test.cpp
#pragma once

#include <softtissue/anatomy/body_anatomy.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace softtissue {

class BoneLofts {
public:
    /// `scale` of the body against the reference skeleton; `density` of rings and sectors, 1 = as drawn.
    BoneLofts(const BodySide& side, double scale, double density)
        : body_(side), mm_(1e-3 * scale), density_(density), trunk_(BodyChart::trunk(side, 0.2 * scale)) {}

    std::vector<AnatomyMesh<double>> take() { return std::move(meshes_); }

protected:
    /// (t, side, front, half width across, half width to the front); all but t in mm.
    using Station = Eigen::Matrix<double, 5, 1>;
    using Stations = std::vector<Station>;

    void start(const char* name) {
        meshes_.push_back({name, AnatomyKind::bone, Matrix3X<double>(3, 0), Triangles(3, 0)});
    }
    Index count(double drawn) const { return std::max(Index(4), Index(std::lround(drawn * density_))); }
    /// Even, so that rings on the mid-line are symmetric.
    Index sectors(double drawn) const { return 2 * ((count(drawn) + 1) / 2); }

    /// A tube through centres with half widths along `across` and its normal; `inside` is a point within the wrap.
    void tube(const std::function<Vector3<double>(double)>& centre,
              const std::function<Eigen::Vector2d(double)>& widths, const Vector3<double>& across,
              const Vector3<double>& front, const Vector3<double>& inside, double rings, double drawn_sectors,
              double roundness) {
        add_loft(meshes_.back(), count(rings), sectors(drawn_sectors), [&](double u, double angle) {
            const Eigen::Vector2d w = rounded_ends(u, roundness) * mm_ * widths(u);
            const Vector3<double> c = body_.within_bone(inside, centre(u), 0.4 * w.minCoeff() + mm_);
            const Vector3<double> p = c + w(0) * std::cos(angle) * across + w(1) * std::sin(angle) * front;
            return body_.within_bone(c, p, mm_);
        });
    }

    /// Along a limb's chart.
    void shaft(const BodyChart& chart, const Stations& stations, double rings, double drawn_sectors,
               double roundness = 0.06) {
        const auto centre = [&](double u) {
            const Station s = along_stations<5>(stations, u);
            return Vector3<double>(chart.origin(s(0)) + mm_ * (s(1) * chart.side() + s(2) * chart.front()));
        };
        // Each ring is drawn back towards its own place on the axis; an axis point in the joint's middle serves all.
        add_loft(meshes_.back(), count(rings), sectors(drawn_sectors), [&](double u, double angle) {
            const Station s = along_stations<5>(stations, u);
            const Eigen::Vector2d w = rounded_ends(u, roundness) * mm_ * s.tail<2>();
            const Vector3<double> axis = chart.origin(std::clamp(s(0), 0.01, 0.99));
            const Vector3<double> c = body_.within_bone(axis, centre(u), 0.4 * w.minCoeff() + mm_);
            const Vector3<double> p =
                c + w(0) * std::cos(angle) * chart.side() + w(1) * std::sin(angle) * chart.front();
            return body_.within_bone(c, p, mm_);
        });
    }

    /// A bulb across a limb at t: from (side, front) along the front, half widths in mm.
    void bulb(const BodyChart& chart, double t, double at_side, double at_front, const Vector3<double>& radii) {
        const Vector3<double> axis = chart.origin(std::clamp(t, 0.01, 0.99));
        const Vector3<double> along = chart.front().cross(chart.side());
        const Vector3<double> middle = chart.origin(t) + mm_ * (at_side * chart.side() + at_front * chart.front());
        tube([&](double u) { return Vector3<double>(middle + mm_ * radii(1) * (2.0 * u - 1.0) * chart.front()); },
             [&](double) { return Eigen::Vector2d(radii(0), radii(2)); }, chart.side(), along, axis, 8, 12, 0.5);
    }

    /// The chest's own ellipse, a part of the trunk of the bone wrap: smooth where the wrap is not.
    double chest_radius(double t, double angle) const {
        const double a = 1e3 * mm_ * shape_.half_width(t);
        const double b = 1e3 * mm_ * shape_.half_depth(t);
        const double radians = angle * std::numbers::pi / 180.0;
        return 0.80 / std::hypot(std::sin(radians) / a, std::cos(radians) / b);
    }

    Vector3<double> chest(double t, double angle, double part) const {
        const Vector3<double> o = trunk_.origin(t);
        return body_.within_bone(o, o + part * chest_radius(t, angle) * trunk_.direction(angle), 2 * mm_);
    }

    /// One arc of a plate: where it lies along the chest and around it, and how far it reaches.
    struct PlateRow {
        double t, angle, half_width, part, half_thickness;
    };

    /// A shell that follows the chest's ellipse.
    void plate(const std::function<PlateRow(double)>& row, double rings, double drawn_sectors) {
        add_loft(meshes_.back(), count(rings), sectors(drawn_sectors), [&](double u, double angle) {
            const PlateRow r = row(u);
            const double size = rounded_ends(u, 0.08);
            const double at = r.angle + size * r.half_width * std::cos(angle);
            const Vector3<double> o = trunk_.origin(r.t);
            const double radius = r.part * chest_radius(r.t, at) + size * mm_ * r.half_thickness * std::sin(angle);
            return body_.within_bone(o, o + radius * trunk_.direction(at), (1.5 - std::sin(angle)) * mm_);
        });
    }

    const BodySide& body_;
    double mm_;
    double density_;
    BodyChart trunk_;
    TrunkShape shape_ = smpl_anatomy().trunk;
    std::vector<AnatomyMesh<double>> meshes_;
};

}  // namespace softtissue
