// SPDX-License-Identifier: MIT
/// @file
/// The point of a triangle, or of a segment, that is closest to a point.
///
/// What        barycentric coordinates of the closest point, and its squared distance.
/// Method      the nearest of the foot on the plane, if it lies in the triangle, and of the closest points on the edges.
/// Shapes      corners 3x3, one a column [m]; barycentric coordinates >= 0 with sum 1; distances squared [m^2].
/// Valid       every triangle, without area or shrunk to a point included.
/// Tests       tests/unit/mesh/closest_point_on_triangle_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <algorithm>

namespace softtissue {

template <RealScalar S>
struct TrianglePoint {
    Vector3<S> barycentric;
    S squared_distance;
};

/// t in [0, 1] such that a + t (b - a) is closest to `p`.
template <RealScalar S>
S closest_point_on_segment(const Vector3<S>& a, const Vector3<S>& b, const Vector3<S>& p) {
    const Vector3<S> edge = b - a;
    const S length2 = edge.squaredNorm();
    return length2 > S(0) ? std::clamp(edge.dot(p - a) / length2, S(0), S(1)) : S(0);
}

template <RealScalar S>
TrianglePoint<S> closest_point_on_triangle(const Matrix3<S>& corners, const Vector3<S>& p) {
    const Matrix3<S> Y = corners.colwise() - p;
    TrianglePoint<S> best{Vector3<S>::Zero(), S(0)};
    const auto offer = [&](const Vector3<S>& barycentric, bool is_first) {
        const Vector3<S> position = Y * barycentric;
        const S squared_distance = position.squaredNorm();
        if (is_first || squared_distance < best.squared_distance) {
            best = {barycentric, squared_distance};
        }
    };
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const S t = closest_point_on_segment<S>(Y.col(k), Y.col(next), Vector3<S>::Zero());
        Vector3<S> barycentric = Vector3<S>::Zero();
        barycentric(k) = S(1) - t;
        barycentric(next) = t;
        offer(barycentric, k == 0);
    }
    const Vector3<S> e1 = Y.col(1) - Y.col(0);
    const Vector3<S> e2 = Y.col(2) - Y.col(0);
    const Vector3<S> n = e1.cross(e2);
    const S n2 = n.squaredNorm();
    const S b1 = -Y.col(0).cross(e2).dot(n);
    const S b2 = -e1.cross(Y.col(0)).dot(n);
    if (b1 > S(0) && b2 > S(0) && b1 + b2 < n2) {
        offer(Vector3<S>((n2 - b1 - b2) / n2, b1 / n2, b2 / n2), false);
    }
    return best;
}

}  // namespace softtissue
