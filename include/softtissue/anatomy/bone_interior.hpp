// SPDX-License-Identifier: MIT
/// @file
/// The inside of the bone wrap as tets that follow the skeleton, to embed bones in.
///
/// What        close_cuts(): the bone wrap with its cuts capped; make_bone_interior(): filled with tets, a row of skinning
///             weights for every vertex, so that one skinning call poses all of them.
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
    Index num_wrap_vertices;     // the first vertices of mesh
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

}  // namespace softtissue
