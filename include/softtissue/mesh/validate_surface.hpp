// SPDX-License-Identifier: MIT
/// @file
/// Refuses surfaces that do not bound a volume.
///
/// What        validate_closed_surface(): passes exactly the closed, oriented, two-manifold surfaces with triangles of
///             positive area, outward orientation and finite coordinates, of one or several pieces.
/// Refuses     coordinate not finite; index out of range; triangle with a repeated vertex or without area; edge with one or
///             more than two triangles, or two that run through it in the same direction; vertex in no triangle or where
///             several fans of triangles meet; enclosed volume <= 0 (InvalidInput names vertex, triangle or edge).
/// Valid       self-intersections are not looked for.
/// Tests       tests/unit/mesh/validate_surface_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace softtissue {

namespace detail {

/// The number of triangles met on the way around `vertex` of a closed surface, from its first triangle through the edges at
/// the vertex; fewer than it has if several fans meet there.
inline Index fan_size(const TriangleMesh& mesh, Index vertex) {
    const std::span<const std::int32_t> triangles = mesh.vertex_triangles(vertex);
    // Of an oriented triangle (v, a, b) the next triangle around v is (v, b, c).
    const auto next_vertex = [&](std::int32_t triangle, int steps) {
        int k = 0;
        while (mesh.triangles()(k, triangle) != vertex) {
            ++k;
        }
        return mesh.triangles()((k + steps) % 3, triangle);
    };
    Index count = 0;
    std::int32_t current = triangles.front();
    do {
        const std::int32_t shared = next_vertex(current, 2);
        current = *std::find_if(triangles.begin(), triangles.end(),
                                [&](std::int32_t t) { return next_vertex(t, 1) == shared; });
        ++count;
    } while (current != triangles.front());
    return count;
}

}  // namespace detail

/// Throws InvalidInput unless the surface bounds a volume; `source` (a file or surface name) starts the message.
template <RealScalar S>
void validate_closed_surface(const Matrix3X<S>& positions, const Triangles& triangles, const std::string& source) {
    for (Index v = 0; v < positions.cols(); ++v) {
        require(positions.col(v).allFinite(), source, ": position of vertex ", v, " is not finite");
    }
    require(triangles.cols() > 0, source, ": no triangles, expected a closed surface");
    const TriangleMesh mesh(triangles, positions.cols(), source);
    for (const TriangleMesh::Edge& edge : mesh.edges()) {
        require(!edge.is_boundary(), source, ": edge (", edge.vertices[0], ", ", edge.vertices[1],
                ") belongs to triangle ", edge.triangles[0], " only, expected a closed surface");
    }
    for (Index v = 0; v < positions.cols(); ++v) {
        const Index count = static_cast<Index>(mesh.vertex_triangles(v).size());
        require(count > 0, source, ": vertex ", v, " is in no triangle");
        require(detail::fan_size(mesh, v) == count, source, ": several fans of triangles meet at vertex ", v,
                ", expected one");
    }
    const VectorX<S> areas = triangle_areas(positions, triangles);
    for (Index t = 0; t < triangles.cols(); ++t) {
        const Vector3<S> a = positions.col(triangles(0, t));
        const Vector3<S> b = positions.col(triangles(1, t));
        const Vector3<S> c = positions.col(triangles(2, t));
        // Below the rounding error of the cross product an area means nothing.
        const S longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        require(areas(t) > S(4) * std::numeric_limits<S>::epsilon() * longest, source, ": triangle ", t, " has area ",
                areas(t), ", expected > 0");
    }
    const S volume = enclosed_volume(positions, triangles);
    require(volume > S(0), source, ": encloses a volume of ", volume, ", expected > 0 (the triangles face inwards)");
}

}  // namespace softtissue
