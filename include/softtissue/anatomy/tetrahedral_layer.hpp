// SPDX-License-Identifier: MIT
/// @file
/// The soft-tissue layer filled with tets by a mesher of the caller's choice.
///
/// What        make_layer_boundary(): the closed surface around a layer; tetrahedralise_layer(): hands it to a callable,
///             checks what comes back, and marks the prescribed vertices.
/// Order       boundary vertex 2 i: inner end of column i, 2 i + 1: its skin end (PrismLayers of one layer); the mesher's own
///             vertices follow.
/// Triangles   for each region triangle the inner one, reversed, then the skin one; then two for each edge of the cuts, the
///             diagonal starting at the smaller index.
/// Callable    Tetrahedralisation<S> operator()(const Matrix3X<S>& positions, const Triangles& triangles): any positions and
///             tets whose first vertices are the given ones, unchanged, and whose outer faces are the given triangles.
/// Prescribed  the inner surface, and both ends of the columns on a cut; vertices of the mesher's own are free.
/// Refuses     moved or missing boundary vertices, an inverted tet, outer faces other than the boundary (InvalidInput).
/// Source      Romero et al. 2020, section 3.2 (a standard meshing software, boundary topology retained).
/// Tests       tests/unit/anatomy/tetrahedral_layer_test.cpp
#pragma once

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/prism_layers.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct Tetrahedralisation {
    Matrix3X<S> positions;
    Connectivity<4> tets;
};

template <class F, class S>
concept Tetrahedraliser = requires(F&& tetrahedralise, const Matrix3X<S>& positions, const Triangles& triangles) {
    { tetrahedralise(positions, triangles) } -> std::same_as<Tetrahedralisation<S>>;
};

template <RealScalar S>
struct LayerBoundary {
    Matrix3X<S> positions;
    Triangles triangles;
};

template <RealScalar S>
struct TetrahedralLayer {
    CellMesh<Tet4, S> mesh;
    std::vector<std::int32_t> prescribed_vertices;  // ascending
    Index num_columns;

    /// The mesh vertices at the ends of a column.
    static std::int32_t inner_vertex(Index column) { return static_cast<std::int32_t>(2 * column); }
    static std::int32_t skin_vertex(Index column) { return static_cast<std::int32_t>(2 * column + 1); }
};

/// The closed surface around the layer, facing outwards.
template <RealScalar S>
LayerBoundary<S> make_layer_boundary(const SoftLayer<S>& layer) {
    using Layer = TetrahedralLayer<S>;
    const SimulatedRegion<S>& region = layer.region;
    LayerBoundary<S> boundary;
    boundary.positions.resize(3, 2 * layer.num_columns());
    const Matrix3X<S> inner = layer.inner_positions();
    for (Index i = 0; i < layer.num_columns(); ++i) {
        boundary.positions.col(Layer::inner_vertex(i)) = inner.col(i);
        boundary.positions.col(Layer::skin_vertex(i)) = layer.skin_positions.col(i);
    }
    std::vector<Vector3<std::int32_t>> triangles;
    for (Index t = 0; t < region.num_triangles(); ++t) {
        const Vector3<std::int32_t> lower = 2 * region.triangles.col(t);
        triangles.emplace_back(lower(0), lower(2), lower(1));
        triangles.emplace_back(lower.array() + 1);
    }
    for (const std::vector<std::int32_t>& loop : region.loops) {
        for (size_t k = 0; k < loop.size(); ++k) {
            const std::int32_t a = Layer::inner_vertex(loop[k]);
            const std::int32_t b = Layer::inner_vertex(loop[(k + 1) % loop.size()]);
            if (a < b) {
                triangles.emplace_back(a, b, b + 1);
                triangles.emplace_back(a, b + 1, a + 1);
            } else {
                triangles.emplace_back(a, b, a + 1);
                triangles.emplace_back(b, b + 1, a + 1);
            }
        }
    }
    boundary.triangles.resize(3, static_cast<Index>(triangles.size()));
    for (size_t t = 0; t < triangles.size(); ++t) {
        boundary.triangles.col(static_cast<Index>(t)) = triangles[t];
    }
    return boundary;
}

namespace detail {

using SortedTriangle = std::array<std::int32_t, 3>;

inline SortedTriangle sorted_triangle(std::int32_t a, std::int32_t b, std::int32_t c) {
    SortedTriangle triangle{a, b, c};
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

/// The faces that belong to one tet only, as sorted vertex triples in ascending order.
inline std::vector<SortedTriangle> outer_faces(const Connectivity<4>& tets) {
    std::vector<SortedTriangle> faces;
    for (Index c = 0; c < tets.cols(); ++c) {
        for (int k = 0; k < 4; ++k) {
            faces.push_back(sorted_triangle(tets((k + 1) % 4, c), tets((k + 2) % 4, c), tets((k + 3) % 4, c)));
        }
    }
    std::sort(faces.begin(), faces.end());
    std::vector<SortedTriangle> outer;
    for (size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
        while (end < faces.size() && faces[end] == faces[begin]) {
            ++end;
        }
        if (end - begin == 1) {
            outer.push_back(faces[begin]);
        }
    }
    return outer;
}

inline void require_same_boundary(const Connectivity<4>& tets, const Triangles& boundary) {
    std::vector<SortedTriangle> wanted;
    for (Index t = 0; t < boundary.cols(); ++t) {
        wanted.push_back(sorted_triangle(boundary(0, t), boundary(1, t), boundary(2, t)));
    }
    std::sort(wanted.begin(), wanted.end());
    const std::vector<SortedTriangle> found = outer_faces(tets);
    const auto [w, f] = std::mismatch(wanted.begin(), wanted.end(), found.begin(), found.end());
    if (w == wanted.end() && f == found.end()) {
        return;
    }
    const bool is_missing = f == found.end() || (w != wanted.end() && *w < *f);
    const SortedTriangle& face = is_missing ? *w : *f;
    throw_invalid_input("tetrahedral layer: ", is_missing ? "boundary triangle (" : "outer face (", face[0], ", ",
                        face[1], ", ", face[2],
                        is_missing ? ") is no outer face of the tets" : ") is no boundary triangle",
                        ", expected the boundary's topology retained");
}

}  // namespace detail

/// The volume of the layer, between the inner surface and the skin, filled by `tetrahedralise`.
template <RealScalar S, Tetrahedraliser<S> F>
TetrahedralLayer<S> tetrahedralise_layer(const SoftLayer<S>& layer, F&& tetrahedralise) {
    const LayerBoundary<S> boundary = make_layer_boundary(layer);
    Tetrahedralisation<S> volume = tetrahedralise(boundary.positions, boundary.triangles);
    const Index num_boundary = boundary.positions.cols();
    require(volume.positions.cols() >= num_boundary, "tetrahedral layer: the mesher returned ", volume.positions.cols(),
            " vertices, expected the ", num_boundary, " of the boundary first");
    for (Index v = 0; v < num_boundary; ++v) {
        require(volume.positions.col(v) == boundary.positions.col(v), "tetrahedral layer: boundary vertex ", v,
                " was moved, expected the vertices of the boundary first and unchanged");
    }
    TetrahedralLayer<S> result{{std::move(volume.positions), std::move(volume.tets)}, {}, layer.num_columns()};
    result.mesh.validate();
    detail::require_same_boundary(result.mesh.cells, boundary.triangles);
    for (Index i = 0; i < layer.num_columns(); ++i) {
        result.prescribed_vertices.push_back(result.inner_vertex(i));
        if (layer.region.is_rim(i)) {
            result.prescribed_vertices.push_back(result.skin_vertex(i));
        }
    }
    return result;
}

}  // namespace softtissue
