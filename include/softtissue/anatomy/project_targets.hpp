// SPDX-License-Identifier: MIT
/// @file
/// Turns the ways from the skin to the bone targets into the skin's validity cones.
///
/// What        project_targets(): targets that every skin vertex can be moved to without passing through its neighbours'
///             columns, near the given ones.
/// Method      Where the smallest cosine of u_i = (T_i - s_i) / |.| is below min(wanted, 0.85 of the best one), u_i is turned
///             towards the best direction until it is not, |T_i - s_i| kept. The changes of T spread to the other vertices by
///             a few rounds of smoothing, which may push further ones out of their cones: repeated.
/// Shapes      skin, targets 3 x n [m]; directions: the best inward ones, 3 x n, and their cosines (repair_skin()).
/// Tests       tests/unit/anatomy/project_targets_test.cpp
#pragma once

#include <softtissue/anatomy/skin_repair.hpp>
#include <softtissue/anatomy/validity_cone.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/umbrella_mean.hpp>

#include <algorithm>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct ProjectedTargets {
    Matrix3X<S> points;
    Index redirected = 0;  // vertices turned into their cones
    int rounds = 0;
};

template <RealScalar S>
ProjectedTargets<S> project_targets(const TriangleMesh& mesh, const RepairedSkin<S>& skin, const Matrix3X<S>& targets,
                                    S wanted_cosine) {
    constexpr int max_rounds = 12;
    constexpr int spreading_rounds = 10;
    const Matrix3X<S> normals = triangle_normals(skin.positions, mesh.triangles());
    ProjectedTargets<S> result{targets};
    std::vector<bool> turned(size_t(mesh.num_vertices()), false);
    for (; result.rounds < max_rounds; ++result.rounds) {
        Matrix3X<S> change = Matrix3X<S>::Zero(3, targets.cols());
        bool is_changed = false;
        for (Index v = 0; v < targets.cols(); ++v) {
            const Vector3<S> way = result.points.col(v) - skin.positions.col(v);
            const S length = way.norm();
            const S wanted = std::min(wanted_cosine, S(0.85) * skin.cosines(v));
            const Matrix3X<S> incident = incident_columns<S>(mesh, normals, v);
            // A little below what the turned ones get, so that rounding does not turn them again.
            if (!(smallest_cosine<S>(incident, way) >= S(0.99) * wanted * length)) {
                const Vector3<S> u = moved_into_cone<S>(incident, way / length, skin.directions.col(v), wanted);
                change.col(v) = length * u - way;
                is_changed = turned[size_t(v)] = true;
            }
        }
        if (!is_changed) {
            break;
        }
        result.points += umbrella_smoothed<S, 3>(mesh, change, spreading_rounds, turned);
    }
    result.redirected = std::count(turned.begin(), turned.end(), true);
    return result;
}

}  // namespace softtissue
