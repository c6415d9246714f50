// SPDX-License-Identifier: MIT
/// @file
/// Fills a closed surface with tets on its own vertices: a mesher without dependency, for embedding.
///
/// What        DelaunayInterior, a Tetrahedraliser (tetrahedral_layer.hpp): the Delaunay tets of the vertices without those
///             outside the surface.
/// Promise     No vertex is added or moved. Every point inside the surface lies in a tet of positive volume; tets do not
///             overlap. Both up to slivers thinner than the grid of grid_predicates.hpp (2^-24 of the extent).
///             The surface's topology is NOT promised: where the Delaunay tets lack a triangle of the surface, tets cross it
///             and reach beyond. tetrahedralise_layer(), which wants the surface kept, refuses these.
/// Use         embedding: the result moves with the surface alone. Not simulation: it has slivers.
/// Valid       closed surfaces, also of several pieces, touching or crossing themselves: inside is a winding number above 1/2.
/// Refuses     a surface that is not closed, a vertex in no triangle, two vertices at one place (InvalidInput)
/// Cost        0.4 s for 4,000 vertices
/// Tests       tests/unit/anatomy/delaunay_interior_test.cpp
#pragma once

#include <softtissue/anatomy/tetrahedral_layer.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/delaunay_tetrahedra.hpp>
#include <softtissue/mesh/grid_predicates.hpp>
#include <softtissue/mesh/triangle_boxes.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/winding_number.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace softtissue {

namespace detail {

/// Whether the open segment a b passes through the inside of triangle c; grid points, decided exactly.
inline bool pierces(const Vector3<double>& a, const Vector3<double>& b, const Matrix3<double>& c) {
    const Vector3<double> c0 = c.col(0);
    const Vector3<double> c1 = c.col(1);
    const Vector3<double> c2 = c.col(2);
    if (orientation(c0, c1, c2, a) * orientation(c0, c1, c2, b) >= 0) {
        return false;
    }
    const int side = orientation(a, b, c0, c1);
    return side != 0 && orientation(a, b, c1, c2) == side && orientation(a, b, c2, c0) == side;
}

/// Whether the triangle runs through the inside of the tet, of which no edge holds a vertex of the triangle.
inline bool runs_through(const Matrix3<double>& triangle, const Eigen::Matrix<double, 3, 4>& tet) {
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
            if (pierces(tet.col(i), tet.col(j), triangle)) {
                return true;
            }
        }
    }
    for (const ElementFace& face : Tet4::faces) {
        Matrix3<double> corners;
        for (int k = 0; k < 3; ++k) {
            corners.col(k) = tet.col(face.nodes[size_t(k)]);
        }
        for (int k = 0; k < 3; ++k) {
            if (pierces(triangle.col(k), triangle.col((k + 1) % 3), corners)) {
                return true;
            }
        }
    }
    return false;
}

/// For each tet, whether a triangle of the surface runs through it.
inline std::vector<bool> crossed_tets(const Matrix3X<double>& points, const Triangles& triangles,
                                      const Connectivity<4>& tets) {
    std::vector<SortedTriangle> faces;
    std::vector<Box<double>> boxes;
    for (Index c = 0; c < tets.cols(); ++c) {
        const NodePositions<Tet4, double> nodes = CellMesh<Tet4, double>::gather(points, tets.col(c));
        boxes.emplace_back(nodes.rowwise().minCoeff(), nodes.rowwise().maxCoeff());
        for (int k = 0; k < 4; ++k) {
            faces.push_back(sorted_triangle(tets((k + 1) % 4, c), tets((k + 2) % 4, c), tets((k + 3) % 4, c)));
        }
    }
    std::sort(faces.begin(), faces.end());
    const BoundingVolumeHierarchy<double> tree(boxes);
    std::vector<bool> crossed(size_t(tets.cols()), false);
    for (Index t = 0; t < triangles.cols(); ++t) {
        if (!std::binary_search(faces.begin(), faces.end(),
                                sorted_triangle(triangles(0, t), triangles(1, t), triangles(2, t)))) {
            const Matrix3<double> corners = triangle_corners(points, triangles, static_cast<std::int32_t>(t));
            const Box<double> box(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff());
            tree.for_each_overlapping(box, [&](std::int32_t c) {
                crossed[size_t(c)] =
                    crossed[size_t(c)] || runs_through(corners, CellMesh<Tet4, double>::gather(points, tets.col(c)));
            });
        }
    }
    return crossed;
}

}  // namespace detail

struct DelaunayInterior {
    template <RealScalar S>
    Tetrahedralisation<S> operator()(const Matrix3X<S>& positions, const Triangles& triangles) const {
        const TriangleMesh surface(triangles, positions.cols());
        for (Index v = 0; v < positions.cols(); ++v) {
            require(!surface.vertex_triangles(v).empty(), "surface: vertex ", v, " is in no triangle");
        }
        for (const TriangleMesh::Edge& edge : surface.edges()) {
            require(!edge.is_boundary(), "surface: edge (", edge.vertices[0], ", ", edge.vertices[1],
                    ") belongs to triangle ", edge.triangles[0], " only, expected a closed surface");
        }
        const Matrix3X<double> points = to_grid(positions);
        const WindingNumber<double> winding_number(points, triangles, 2.0);  // exact to 1e-2, enough to tell 0 from 1
        const Connectivity<4> all = delaunay_tetrahedra(points);
        const std::vector<bool> crossed = detail::crossed_tets(points, triangles, all);
        std::vector<Index> kept;
        for (Index c = 0; c < all.cols(); ++c) {
            const Vector3<double> centre = CellMesh<Tet4, double>::gather(points, all.col(c)).rowwise().mean();
            // Off the grid a sliver may be flat or turned over.
            const bool is_positive =
                Tet4::smallest_jacobian_bound(CellMesh<Tet4, S>::gather(positions, all.col(c))) > S(0);
            if (is_positive && (crossed[size_t(c)] || winding_number(centre) > 0.5)) {
                kept.push_back(c);
            }
        }
        Tetrahedralisation<S> result{positions, Connectivity<4>(4, static_cast<Index>(kept.size()))};
        for (size_t i = 0; i < kept.size(); ++i) {
            result.tets.col(static_cast<Index>(i)) = all.col(kept[i]);
        }
        return result;
    }
};

}  // namespace softtissue
