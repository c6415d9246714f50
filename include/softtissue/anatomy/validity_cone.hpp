// SPDX-License-Identifier: MIT
/// @file
/// The directions in which a layer can leave a skin vertex.
///
/// What        the inward direction that sees all incident triangles best, and the change of a given direction that makes it
///             see them well enough.
/// Equation    c(u) = min over the incident triangles f of -n_f . u. A prism below f can be valid near the vertex only if
///             c(u) > 0, so a vertex whose best c is <= 0 admits no layer at all.
/// Shapes      normals 3 x k, unit, outwards; directions unit, inwards.
/// Valid       the best direction is exact: it is equally far from two or three of the normals, and all such are tried.
/// Cost        best_inward_direction O(k^4) for k incident triangles (k is about 6)
/// Tests       tests/unit/anatomy/validity_cone_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace softtissue {

template <RealScalar S>
struct InwardDirection {
    Vector3<S> direction;
    S cosine;
};

/// The columns of a per-triangle array (such as normals) that belong to the triangles at `vertex`, 3 x k.
template <RealScalar S>
Matrix3X<S> incident_columns(const TriangleMesh& mesh, const Matrix3X<S>& per_triangle, Index vertex) {
    const std::span<const std::int32_t> triangles = mesh.vertex_triangles(vertex);
    Matrix3X<S> incident(3, static_cast<Index>(triangles.size()));
    for (size_t k = 0; k < triangles.size(); ++k) {
        incident.col(static_cast<Index>(k)) = per_triangle.col(triangles[k]);
    }
    return incident;
}

/// c(u): the smallest cosine between the inward direction `u` and the inward normals.
template <RealScalar S>
S smallest_cosine(const Matrix3X<S>& normals, const Vector3<S>& u) {
    S largest = normals.col(0).dot(u);
    for (Index k = 1; k < normals.cols(); ++k) {
        largest = std::max(largest, normals.col(k).dot(u));
    }
    return -largest;
}

/// The unit direction of the largest c(u), and that value (not positive: there is no valid direction).
template <RealScalar S>
InwardDirection<S> best_inward_direction(const Matrix3X<S>& normals) {
    using std::sqrt;
    InwardDirection<S> best{-normals.col(0), S(-2)};
    const auto consider = [&](const Vector3<S>& candidate) {
        const S length = candidate.norm();
        if (length > sqrt(std::numeric_limits<S>::epsilon())) {
            const Vector3<S> u = candidate / length;
            const S cosine = smallest_cosine(normals, u);
            if (cosine > best.cosine) {
                best = {u, cosine};
            }
        }
    };
    for (Index a = 0; a < normals.cols(); ++a) {
        const Vector3<S> na = normals.col(a);
        consider(-na);
        for (Index b = 0; b < a; ++b) {
            const Vector3<S> nb = normals.col(b);
            consider(-(na + nb));
            for (Index c = 0; c < b; ++c) {
                const Vector3<S> nc = normals.col(c);
                const Vector3<S> axis = (na - nb).cross(na - nc);
                consider(axis);
                consider(-axis);
            }
        }
    }
    return best;
}

/// The direction between `u` and `best` closest to `u` with c >= `wanted`; `best` if there is none.
template <RealScalar S>
Vector3<S> moved_into_cone(const Matrix3X<S>& normals, const Vector3<S>& u, const Vector3<S>& best, S wanted) {
    if (smallest_cosine(normals, u) >= wanted) {
        return u;
    }
    // c is quasi-concave along the arc from u to best, so the part with c >= wanted is one interval that ends at best.
    S outside(0);
    S inside(1);
    for (int halving = 0; halving < 30; ++halving) {
        const S middle = (outside + inside) / S(2);
        const Vector3<S> candidate = ((S(1) - middle) * u + middle * best).stableNormalized();
        (smallest_cosine(normals, candidate) >= wanted ? inside : outside) = middle;
    }
    return ((S(1) - inside) * u + inside * best).stableNormalized();
}

}  // namespace softtissue
