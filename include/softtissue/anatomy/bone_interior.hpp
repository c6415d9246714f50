// SPDX-License-Identifier: MIT
/// @file
/// The inside of the bone wrap as tets that follow the skeleton, to embed bones in.
///
/// What        close_cuts(): the bone wrap with its cuts capped; make_bone_interior(): filled with tets, a row of skinning
///             weights for every vertex, so that one skinning call poses all of them; join_to_layers(): numbered like
///             the layers around the bone wrap, for an Embedding in both.
/// Order       vertices of the bone wrap; the middle of each cut, as boundary_loops() orders them; what the mesher adds.
/// Weights     bone wrap: as given. Middle of a cut: the mean over its loop. Added by the mesher: harmonic between these,
///             clamped to >= 0 and normalised.
/// Callable    a Tetrahedraliser. DelaunayInterior, the default, adds no vertex and covers the whole inside; a mesher that
///             keeps the surface (TetGen, -pYY) serves as well.
/// Shapes      positions 3 x n [m], triangles 3 x m facing outwards, weights n rows; posed positions have the mesh's order.
/// Refuses     a count of weights other than of positions, moved or missing boundary vertices, an inverted tet (InvalidInput)
/// Source      Nolte et al. 2026, section 3.1 (tetrahedral bone mesh).
/// Tests       tests/unit/anatomy/bone_interior_test.cpp
#pragma once

#include <softtissue/anatomy/delaunay_interior.hpp>
#include <softtissue/anatomy/tetrahedral_layer.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/harmonic.hpp>
#include <softtissue/mesh/laplacian.hpp>
#include <softtissue/mesh/prism_layers.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/skinning/weights.hpp>

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct BoneInterior {
    CellMesh<Tet4, S> mesh;
    SkinningWeights<S> weights;  // one row per vertex of mesh
    Index
        num_given_vertices;  // the first vertices of mesh: those of the bone wrap, or of the layers (join_to_layers())
};

/// The surface with a fan around a new vertex, the mean of the loop, over each boundary loop.
template <RealScalar S>
LayerBoundary<S> close_cuts(const Matrix3X<S>& positions, const Triangles& triangles) {
    const std::vector<std::vector<std::int32_t>> loops =
        TriangleMesh(triangles, positions.cols(), "bone wrap").boundary_loops();
    size_t rim = 0;
    for (const std::vector<std::int32_t>& loop : loops) {
        rim += loop.size();
    }
    LayerBoundary<S> closed{Matrix3X<S>(3, positions.cols() + Index(loops.size())),
                            Triangles(3, triangles.cols() + Index(rim))};
    closed.positions.leftCols(positions.cols()) = positions;
    closed.triangles.leftCols(triangles.cols()) = triangles;
    Index middle = positions.cols();
    Index t = triangles.cols();
    for (const std::vector<std::int32_t>& loop : loops) {
        Vector3<S> mean = Vector3<S>::Zero();
        for (size_t k = 0; k < loop.size(); ++k) {
            mean += positions.col(loop[k]);
            closed.triangles.col(t++) << loop[(k + 1) % loop.size()], loop[k], static_cast<std::int32_t>(middle);
        }
        closed.positions.col(middle++) = mean / S(loop.size());
    }
    return closed;
}

namespace detail {

/// Rows for the bone wrap, for the middle of each of its cuts, and for the vertices a mesher added.
template <RealScalar S>
SkinningWeights<S> interior_weights(const SkinningWeights<S>& wrap_weights, const LayerBoundary<S>& closed,
                                    const CellMesh<Tet4, S>& mesh) {
    const Index num_wrap = wrap_weights.num_vertices();
    const Index num_closed = closed.positions.cols();
    MatrixX<S> dense = MatrixX<S>::Zero(num_closed, wrap_weights.num_joints());
    dense.topRows(num_wrap) = wrap_weights.dense();
    for (Index t = 0; t < closed.triangles.cols(); ++t) {
        const std::int32_t middle = closed.triangles(2, t);
        if (middle >= num_wrap) {
            dense.row(middle) += dense.row(closed.triangles(1, t));
        }
    }
    for (Index v = num_wrap; v < num_closed; ++v) {
        dense.row(v) /= dense.row(v).sum();
    }
    if (mesh.num_vertices() > num_closed) {
        std::vector<std::int32_t> known(static_cast<size_t>(num_closed));
        std::iota(known.begin(), known.end(), 0);
        const HarmonicInterpolation<S> from_boundary(cotangent_laplacian(mesh), known);
        dense = from_boundary.interpolate(dense).cwiseMax(S(0)).eval();
        for (Index v = num_closed; v < dense.rows(); ++v) {
            dense.row(v) /= dense.row(v).sum();
        }
    }
    return SkinningWeights<S>(dense);
}

}  // namespace detail

/// `weights` holds one row per vertex of the bone wrap, which may have boundary loops (cuts).
template <RealScalar S, Tetrahedraliser<S> F = DelaunayInterior>
BoneInterior<S> make_bone_interior(const Matrix3X<S>& positions, const Triangles& triangles,
                                   const SkinningWeights<S>& weights, F&& tetrahedralise = {}) {
    require(weights.num_vertices() == positions.cols(), "bone interior: ", weights.num_vertices(),
            " rows of weights, expected one for each of the ", positions.cols(), " vertices of the bone wrap");
    const LayerBoundary<S> closed = close_cuts(positions, triangles);
    Tetrahedralisation<S> volume = tetrahedralise(closed.positions, closed.triangles);
    const Index num_closed = closed.positions.cols();
    require(volume.positions.cols() >= num_closed && volume.positions.leftCols(num_closed) == closed.positions,
            "bone interior: the mesher lost or moved a boundary vertex, expected all ", num_closed,
            " of them first and unchanged");
    BoneInterior<S> interior{{std::move(volume.positions), std::move(volume.tets)}, {}, positions.cols()};
    interior.mesh.validate();
    interior.weights = detail::interior_weights(weights, closed, interior.mesh);
    return interior;
}

/// The interior renumbered to share the vertices of a layered mesh whose level 0 is its bone wrap: the vertices of the
/// layered mesh, with the given rest positions and weights, then the interior's other ones.
template <RealScalar S>
BoneInterior<S> join_to_layers(const BoneInterior<S>& interior, const PrismLayers& layers,
                               const Matrix3X<S>& rest_positions, const SkinningWeights<S>& weights) {
    const Index num_wrap = interior.num_given_vertices;
    const Index num_other = interior.mesh.num_vertices() - num_wrap;
    const Index num_layered = layers.num_vertices();
    require(layers.num_columns == num_wrap && rest_positions.cols() == num_layered &&
                weights.num_vertices() == num_layered && weights.num_joints() == interior.weights.num_joints(),
            "bone interior: layers of ", layers.num_columns, " columns with ", rest_positions.cols(), " positions and ",
            weights.num_vertices(), " rows of weights of ", weights.num_joints(), " joints do not fit a bone wrap of ",
            num_wrap, " vertices and ", interior.weights.num_joints(), " joints");
    const Matrix3X<S> wrap = layers.level_positions(rest_positions, 0);
    require(wrap == interior.mesh.rest_positions.leftCols(num_wrap),
            "bone interior: level 0 of the layers is not the bone wrap that was filled");
    BoneInterior<S> joined{{Matrix3X<S>(3, num_layered + num_other), interior.mesh.cells}, {}, num_layered};
    joined.mesh.rest_positions << rest_positions, interior.mesh.rest_positions.rightCols(num_other);
    for (Index c = 0; c < joined.mesh.num_cells(); ++c) {
        for (std::int32_t& v : joined.mesh.cells.col(c)) {
            v = static_cast<std::int32_t>(v < num_wrap ? layers.vertex(v, 0) : num_layered + v - num_wrap);
        }
    }
    MatrixX<S> dense(num_layered + num_other, weights.num_joints());
    dense << weights.dense(), interior.weights.dense().bottomRows(num_other);
    joined.weights = SkinningWeights<S>(dense);
    return joined;
}

}  // namespace softtissue
