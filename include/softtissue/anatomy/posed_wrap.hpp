// SPDX-License-Identifier: MIT
/// @file
/// Whether an inner surface that skinning has posed can still carry a layer.
///
/// What        examine_posed_wrap(): counts of folded triangles and of vertices above which no valid prism exists, whatever
///             the surface above.
/// Equation    folded:      n_posed . R n_rest <= 0,  R the blended rotation of the triangle's bones;
///             infeasible:  max over unit d of min_f n_f . d <= 0,  f the posed triangles at the vertex (validity_cone.hpp).
/// Shapes      rest, posed 3 x n [m]; triangles 3 x m; rotations: one per triangle.
/// Why         a bone wrap moved by linear blend skinning with the skin's own weights folds at groin and armpit; the smoothed
///             weights of a LayeredBody prevent nearly all of it. Muscle prisms above an infeasible vertex are inverted at
///             every equilibrium, which no solver can help.
/// Tests       tests/unit/anatomy/posed_wrap_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/anatomy/validity_cone.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/cell_weights.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct PosedWrapReport {
    Index folded_triangles = 0;
    Index infeasible_vertices = 0;
    Index crossings = 0;                                         // pairs of triangles
    S smallest_cosine = std::numeric_limits<S>::infinity();      // of the best direction of the worst vertex
    S smallest_area_ratio = std::numeric_limits<S>::infinity();  // posed to rest
};

/// See the file comment.
template <RealScalar S>
PosedWrapReport<S> examine_posed_wrap(const TriangleMesh& mesh, const Matrix3X<S>& rest, const Matrix3X<S>& posed,
                                      std::span<const Matrix3<S>> rotations) {
    require(rest.cols() == mesh.num_vertices() && posed.cols() == mesh.num_vertices(), "posed wrap: ", rest.cols(),
            " rest and ", posed.cols(), " posed vertices, expected ", mesh.num_vertices());
    require(static_cast<Index>(rotations.size()) == mesh.num_triangles(), "posed wrap: ", rotations.size(),
            " rotations, expected one for each of the ", mesh.num_triangles(), " triangles");
    PosedWrapReport<S> report;
    const Matrix3X<S> rest_areas = area_vectors(rest, mesh.triangles());
    const Matrix3X<S> posed_areas = area_vectors(posed, mesh.triangles());
    for (Index t = 0; t < mesh.num_triangles(); ++t) {
        const Vector3<S> expected = rotations[size_t(t)] * rest_areas.col(t);
        report.folded_triangles += expected.dot(posed_areas.col(t)) > S(0) ? 0 : 1;
        report.smallest_area_ratio =
            std::min(report.smallest_area_ratio, posed_areas.col(t).norm() / rest_areas.col(t).norm());
    }
    const Matrix3X<S> normals = triangle_normals(posed, mesh.triangles());
    for (Index v = 0; v < mesh.num_vertices(); ++v) {
        const S cosine = best_inward_direction<S>(incident_columns<S>(mesh, normals, v)).cosine;
        report.infeasible_vertices += cosine > S(0) ? 0 : 1;
        report.smallest_cosine = std::min(report.smallest_cosine, cosine);
    }
    report.crossings = static_cast<Index>(crossing_triangles<S>(posed, mesh.triangles()).size());
    return report;
}

/// The bone wrap of a layered body at `posed` positions (3 x columns) for the joint transforms of a pose.
template <RealScalar S>
PosedWrapReport<S> examine_posed_wrap(const LayeredBody<S>& body, const Matrix3X<S>& posed,
                                      std::span<const AffineTransform<S>> joint_transforms) {
    const Connectivity<3> triangles = body.mesh.cells.leftCols(body.num_muscle_cells()).template topRows<3>();
    const BlendedRotations<S> blended(cell_weights<S, 3>(body.weights, triangles));
    std::vector<Matrix3<S>> rotations(size_t(triangles.cols()));
    blended.rotations_into(bone_quaternions<S>(joint_transforms), rotations);
    const TriangleMesh mesh(body.region.triangles, body.num_columns());
    return examine_posed_wrap<S>(mesh, body.level_positions(0), posed, rotations);
}

}  // namespace softtissue
