// SPDX-License-Identifier: MIT
/// @file
/// The hinges of a triangle surface: its interior edges with the two triangles that meet there.
///
/// What        interior_hinges(): one column (i, j, k, l) per edge of two triangles, ascending as in TriangleMesh::edges();
///             the edge runs i -> j in its first triangle (i, j, k); the second one is (j, i, l).
/// Shapes      4 x hinges, vertex indices of the surface, which may be those of a larger volume mesh
/// Valid       surfaces with boundary: a boundary edge is no hinge
/// Tests       tests/unit/mesh/hinges_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cstdint>

namespace softtissue {

namespace detail {

/// The vertex of a triangle that is not on the edge.
inline std::int32_t opposite_vertex(const TriangleMesh& surface, const TriangleMesh::Edge& edge, std::int32_t triangle) {
    int k = 0;
    while (surface.triangles()(k, triangle) == edge.vertices[0] || surface.triangles()(k, triangle) == edge.vertices[1]) {
        ++k;
    }
    return surface.triangles()(k, triangle);
}

}  // namespace detail

inline Connectivity<4> interior_hinges(const TriangleMesh& surface) {
    const auto is_interior = [](const TriangleMesh::Edge& edge) { return !edge.is_boundary(); };
    Connectivity<4> hinges(4, std::count_if(surface.edges().begin(), surface.edges().end(), is_interior));
    Index h = 0;
    for (const TriangleMesh::Edge& edge : surface.edges()) {
        if (is_interior(edge)) {
            hinges.col(h++) << edge.vertices[0], edge.vertices[1], detail::opposite_vertex(surface, edge, edge.triangles[0]),
                detail::opposite_vertex(surface, edge, edge.triangles[1]);
        }
    }
    return hinges;
}

}  // namespace softtissue
