// SPDX-License-Identifier: MIT
/// @file
/// How far a ray goes before it meets a triangle surface.
///
/// What        RayDistance: first hit of rays against triangles, from either side, closed or not.
/// Equation    o + s d = a + v (b - a) + w (c - a), solved by Cramer's rule
/// Shapes      positions 3 x n [m], triangles 3 x m; the distance is in units of |d|, infinity without a hit.
/// Valid       a ray through an edge or vertex meets one of its triangles at least (barycentric tolerance 1e-9 / 1e-5 in
///             float); one within the plane of a triangle does not meet it.
/// Source      Moeller, Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection"
/// Cost        O(log m) a ray where few boxes lie on it
/// Tests       tests/unit/mesh/ray_distance_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>
#include <softtissue/mesh/triangle_boxes.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace softtissue {

template <RealScalar S>
class RayDistance {
public:
    RayDistance(Matrix3X<S> positions, Triangles triangles)
        : positions_(std::move(positions)),
          triangles_(std::move(triangles)),
          tree_(triangle_boxes(positions_, triangles_)) {}

    S operator()(const Vector3<S>& origin, const Vector3<S>& direction) const {
        S nearest = std::numeric_limits<S>::infinity();
        for (std::size_t k = 0; k < tree_.nodes().size();) {
            const auto& node = tree_.nodes()[k];
            if (!meets(node.box, origin, direction, nearest)) {
                k = size_t(node.next);
                continue;
            }
            if (node.is_leaf()) {
                for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
                    nearest = std::min(nearest, hit(tree_.slot_items()[size_t(slot)], origin, direction));
                }
            }
            ++k;
        }
        return nearest;
    }

private:
    static constexpr S tolerance = std::is_same_v<S, float> ? S(1e-5) : S(1e-9);

    /// Whether the box holds a point of the ray up to `farthest`.
    static bool meets(const Box<S>& box, const Vector3<S>& origin, const Vector3<S>& direction, S farthest) {
        S enter(0);
        S leave = farthest;
        for (Index i = 0; i < 3; ++i) {
            if (direction(i) == S(0)) {
                if (origin(i) < box.min()(i) || origin(i) > box.max()(i)) {
                    return false;
                }
                continue;
            }
            const S to_min = (box.min()(i) - origin(i)) / direction(i);
            const S to_max = (box.max()(i) - origin(i)) / direction(i);
            enter = std::max(enter, std::min(to_min, to_max) * (S(1) - tolerance));
            leave = std::min(leave, std::max(to_min, to_max) * (S(1) + tolerance));
        }
        return enter <= leave;
    }

    S hit(std::int32_t triangle, const Vector3<S>& origin, const Vector3<S>& direction) const {
        const Matrix3<S> corners = triangle_corners(positions_, triangles_, triangle);
        const Vector3<S> ab = corners.col(1) - corners.col(0);
        const Vector3<S> ac = corners.col(2) - corners.col(0);
        const Vector3<S> across = direction.cross(ac);
        const S determinant = ab.dot(across);
        const Vector3<S> to_origin = origin - corners.col(0);
        const Vector3<S> turned = to_origin.cross(ab);
        const S v = to_origin.dot(across) / determinant;
        const S w = direction.dot(turned) / determinant;
        const S distance = ac.dot(turned) / determinant;
        // False for the infinities and NaN of a ray within the plane, too.
        const bool is_hit = v >= -tolerance && w >= -tolerance && v + w <= S(1) + tolerance && distance >= S(0);
        return is_hit ? distance : std::numeric_limits<S>::infinity();
    }

    Matrix3X<S> positions_;
    Triangles triangles_;
    BoundingVolumeHierarchy<S> tree_;
};

}  // namespace softtissue
