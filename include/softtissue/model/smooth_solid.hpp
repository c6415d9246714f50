// SPDX-License-Identifier: MIT
/// @file
/// Solids as signed distances that melt into each other: the clay of the procedural body.
///
/// What        smooth union and intersection; ellipsoid, tapered capsule, and a tube of varying cross section.
/// Equation    union: min(a, b) - k/6 h^3, h = max(0, 1 - |a - b|/k): twice continuously differentiable, symmetric
///             in a and b, equal to min(a, b) where |a - b| >= k.
///             Shapes: (N - 1)/|grad N| with N of degree one and N = 1 on the surface: first-order distance.
/// Shapes      points 3 [m]; distances [m], negative inside.
/// Valid       near the surface (a few radii); far away the sign is right and the value only grows.
/// Tests       tests/unit/model/smooth_solid_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace softtissue {

/// Union of two distances, rounded over a width of `blend` > 0 metres.
inline double smooth_union(double a, double b, double blend) {
    const double h = std::max(0.0, 1.0 - std::abs(a - b) / blend);
    return std::min(a, b) - blend / 6.0 * h * h * h;
}

/// Intersection of two distances, rounded over `blend` metres.
inline double smooth_intersection(double a, double b, double blend) {
    return -smooth_union(-a, -b, blend);
}

/// Ellipsoid with axes along the columns of `axes` (a rotation).
struct Ellipsoid {
    Vector3<double> center;
    Vector3<double> radii;
    Matrix3<double> axes = Matrix3<double>::Identity();

    double distance(const Vector3<double>& x) const {
        const Vector3<double> scaled = (axes.transpose() * (x - center)).cwiseQuotient(radii);
        const double n = scaled.norm();
        const double slope = scaled.cwiseQuotient(radii).norm();
        return slope > 0.0 ? n * (n - 1.0) / slope : -radii.minCoeff();
    }
};

/// The spheres that roll from one end to the other while their radius changes linearly.
struct TaperedCapsule {
    Vector3<double> from;
    Vector3<double> to;
    double radius_from;
    double radius_to;

    double distance(const Vector3<double>& x) const {
        const Vector3<double> axis = to - from;
        const double t = std::clamp(axis.dot(x - from) / axis.squaredNorm(), 0.0, 1.0);
        return (x - from - t * axis).norm() - (radius_from + t * (radius_to - radius_from));
    }
};

/// Cross section of a tube at t (0 at its origin, 1 at its end): half widths along +side, -side, +front, -front,
/// and the offset of its centre along front, all in metres.
struct TubeSection {
    double t;
    double outer;
    double inner;
    double front;
    double back;
    double shift = 0.0;
};

/// A straight tube whose section is made of four quarter ellipses (roundness 1) or squarer arcs (roundness < 1),
/// interpolated along the axis by cubic Hermite splines, closed by round ends at the first and the last section.
class Tube {
public:
    /// `front` is made perpendicular to the axis; the side direction is front x axis.
    Tube(const Vector3<double>& origin, const Vector3<double>& end, const Vector3<double>& front,
         std::vector<TubeSection> sections, double roundness = 1.0)
        : origin_(origin), length_((end - origin).norm()), sections_(std::move(sections)), roundness_(roundness) {
        axis_ = (end - origin) / length_;
        front_ = (front - front.dot(axis_) * axis_).normalized();
        side_ = cross(front_, axis_);
        for (const TubeSection& s : sections_) {
            reach_ = std::max({reach_, s.outer, s.inner, s.front + std::abs(s.shift), s.back + std::abs(s.shift)});
        }
        reach_ *= 1.2;  // squarer arcs reach past their half widths
    }

    double distance(const Vector3<double>& x) const {
        const Vector3<double> d = x - origin_;
        const double along = axis_.dot(d);
        const double t = std::clamp(along / length_, sections_.front().t, sections_.back().t);
        const double overshoot = along - t * length_;
        const double far = (d - t * length_ * axis_).norm() - reach_;
        if (far > far_away) {
            return far;
        }
        const TubeSection s = section(t);
        const double u = side_.dot(d);
        const double v = front_.dot(d) - s.shift;
        return from_norm({u, v, overshoot}, u > 0.0 ? s.outer : s.inner, v > 0.0 ? s.front : s.back,
                         std::min({s.outer, s.inner, s.front, s.back}));
    }

private:
    static Vector3<double> cross(const Vector3<double>& a, const Vector3<double>& b) {
        return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
    }

    static constexpr double far_away = 0.1;  // wider than any blend, so that it never shows

    double from_norm(const Vector3<double>& local, double a, double b, double c) const {
        const double p = local(0) / a;
        const double q = local(1) / b;
        const double w = local(2) / c;
        const double planar2 = std::sqrt(p * p * p * p + q * q * q * q + 2.0 * roundness_ * p * p * q * q);
        const double n = std::sqrt(planar2 + w * w);
        if (n < 1e-9) {
            return -c;
        }
        Vector3<double> slope(0.0, 0.0, w / c);
        if (planar2 > 0.0) {
            slope(0) = (p * p * p + roundness_ * p * q * q) / (planar2 * a);
            slope(1) = (q * q * q + roundness_ * q * p * p) / (planar2 * b);
        }
        return n * (n - 1.0) / slope.norm();
    }

    TubeSection section(double t) const {
        size_t i = 0;
        while (i + 2 < sections_.size() && t > sections_[i + 1].t) {
            ++i;
        }
        const TubeSection& s0 = sections_[i];
        const TubeSection& s1 = sections_[i + 1];
        const TubeSection& before = sections_[i == 0 ? 0 : i - 1];
        const TubeSection& after = sections_[std::min(i + 2, sections_.size() - 1)];
        const double h = s1.t - s0.t;
        const double r = (t - s0.t) / h;
        const double basis0 = (1.0 + 2.0 * r) * (1.0 - r) * (1.0 - r);
        const double basis1 = r * (1.0 - r) * (1.0 - r) * h / (s1.t - before.t);
        const double basis2 = r * r * (r - 1.0) * h / (after.t - s0.t);
        const auto blend = [&](double TubeSection::*m) {
            return basis0 * s0.*m + (1.0 - basis0) * s1.*m + basis1 * (s1.*m - before.*m) + basis2 * (after.*m - s0.*m);
        };
        return {t,
                blend(&TubeSection::outer),
                blend(&TubeSection::inner),
                blend(&TubeSection::front),
                blend(&TubeSection::back),
                blend(&TubeSection::shift)};
    }

    Vector3<double> origin_;
    Vector3<double> axis_;
    Vector3<double> front_;
    Vector3<double> side_;
    double length_;
    double reach_ = 0.0;
    std::vector<TubeSection> sections_;
    double roundness_;
};

/// Value and gradient of a distance at x, from four samples on a tetrahedron around it: errors of second and of first
/// order in `step`.
struct DistanceSample {
    double value;
    Vector3<double> gradient;
};

template <class Distance>
DistanceSample sample_distance(const Distance& distance, const Vector3<double>& x, double step = 1e-5) {
    static const std::array<Vector3<double>, 4> corners{Vector3<double>(1, -1, -1), Vector3<double>(-1, -1, 1),
                                                        Vector3<double>(-1, 1, -1), Vector3<double>(1, 1, 1)};
    DistanceSample sample{0.0, Vector3<double>::Zero()};
    for (const Vector3<double>& e : corners) {
        const double f = distance(Vector3<double>(x + step * e));
        sample.value += 0.25 * f;
        sample.gradient += 0.25 / step * f * e;
    }
    return sample;
}

}  // namespace softtissue
