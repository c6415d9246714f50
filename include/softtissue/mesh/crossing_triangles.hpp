// SPDX-License-Identifier: MIT
/// @file
/// Pairs of triangles that cross each other.
///
/// What        all pairs, within one surface or between two, of which an edge of one passes through the inside of the other.
/// Shapes      positions 3 x n [m], triangles 3 x m; pairs ascending. Within one surface the smaller triangle is first,
///             between two that of the first surface.
/// Valid       Touching or coplanar triangles do not count as crossing. Within one surface pairs that share a vertex are not
///             tested: a fold at a common edge or vertex is not found.
/// Refuses     corners out of range or not finite (InvalidInput)
/// Cost        a tree of boxes for each surface, O(m log m).
/// Tests       tests/unit/mesh/crossing_triangles_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>
#include <softtissue/mesh/triangle_boxes.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

/// Whether the open segment from a to b passes through the inside of the triangle of the columns of `corners`.
template <RealScalar S>
bool segment_crosses_triangle(const Vector3<S>& a, const Vector3<S>& b, const Matrix3<S>& corners) {
    const auto volume = [](const Vector3<S>& p, const Vector3<S>& q, const Vector3<S>& r, const Vector3<S>& s) {
        return (q - p).cross(r - p).dot(s - p);
    };
    const Vector3<S> c0 = corners.col(0);
    const Vector3<S> c1 = corners.col(1);
    const Vector3<S> c2 = corners.col(2);
    if (!(volume(c0, c1, c2, a) * volume(c0, c1, c2, b) < S(0))) {
        return false;
    }
    const S v0 = volume(a, b, c0, c1);
    const S v1 = volume(a, b, c1, c2);
    const S v2 = volume(a, b, c2, c0);
    return (v0 > S(0) && v1 > S(0) && v2 > S(0)) || (v0 < S(0) && v1 < S(0) && v2 < S(0));
}

template <RealScalar S>
bool triangles_cross(const Matrix3<S>& p, const Matrix3<S>& q) {
    for (int k = 0; k < 3; ++k) {
        if (segment_crosses_triangle<S>(p.col(k), p.col((k + 1) % 3), q) ||
            segment_crosses_triangle<S>(q.col(k), q.col((k + 1) % 3), p)) {
            return true;
        }
    }
    return false;
}

}  // namespace detail

using TrianglePairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Where a surface crosses itself.
template <RealScalar S>
TrianglePairs crossing_triangles(const Matrix3X<S>& positions, const Triangles& triangles) {
    TrianglePairs crossings;
    const BoundingVolumeHierarchy<S> tree(triangle_boxes(positions, triangles));
    tree.for_each_overlapping_pair([&](std::int32_t s, std::int32_t t) {
        for (int k = 0; k < 3; ++k) {
            if ((triangles.col(t).array() == triangles(k, s)).any()) {
                return;
            }
        }
        if (detail::triangles_cross<S>(triangle_corners(positions, triangles, s),
                                       triangle_corners(positions, triangles, t))) {
            crossings.emplace_back(s, t);
        }
    });
    std::sort(crossings.begin(), crossings.end());
    return crossings;
}

/// Where two surfaces, each with its own vertices, cross one another.
template <RealScalar S>
TrianglePairs crossing_triangles(const Matrix3X<S>& first_positions, const Triangles& first_triangles,
                                 const Matrix3X<S>& second_positions, const Triangles& second_triangles) {
    TrianglePairs crossings;
    const BoundingVolumeHierarchy<S> first(triangle_boxes(first_positions, first_triangles));
    const BoundingVolumeHierarchy<S> second(triangle_boxes(second_positions, second_triangles));
    first.for_each_overlapping_pair(second, [&](std::int32_t s, std::int32_t t) {
        if (detail::triangles_cross<S>(triangle_corners(first_positions, first_triangles, s),
                                       triangle_corners(second_positions, second_triangles, t))) {
            crossings.emplace_back(s, t);
        }
    });
    std::sort(crossings.begin(), crossings.end());
    return crossings;
}

}  // namespace softtissue
