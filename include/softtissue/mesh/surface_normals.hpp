// SPDX-License-Identifier: MIT
/// @file
/// Normals and areas of triangles, normals of vertices.
///
/// What        area vectors (normal times area) of the triangles; unit normals of triangles and vertices, outwards.
/// Equation    a_t = (x_1 - x_0) x (x_2 - x_0) / 2;   n_v = sum of the a_t around v, normalised (area-weighted).
/// Shapes      positions 3 x n [m], triangles 3 x m; area vectors 3 x m [m^2]; normals 3 x m or 3 x n.
/// Valid       a triangle without area, or a vertex whose area vectors cancel or that has no triangle, gets a zero normal.
/// Tests       tests/unit/mesh/surface_normals_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

namespace softtissue {

/// Normal times area of every triangle, 3 x m [m^2].
template <RealScalar S>
Matrix3X<S> area_vectors(const Matrix3X<S>& positions, const Triangles& triangles) {
    Matrix3X<S> areas(3, triangles.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        const Vector3<S> a = positions.col(triangles(0, t));
        const Vector3<S> e1 = positions.col(triangles(1, t)) - a;
        const Vector3<S> e2 = positions.col(triangles(2, t)) - a;
        areas.col(t) = S(0.5) * e1.cross(e2);
    }
    return areas;
}

namespace detail {

/// A column of zeros stays zero.
template <RealScalar S>
void normalise_columns(Matrix3X<S>& vectors) {
    for (Index i = 0; i < vectors.cols(); ++i) {
        vectors.col(i).normalize();
    }
}

}  // namespace detail

/// Unit normal of every triangle.
template <RealScalar S>
Matrix3X<S> triangle_normals(const Matrix3X<S>& positions, const Triangles& triangles) {
    Matrix3X<S> normals = area_vectors(positions, triangles);
    detail::normalise_columns(normals);
    return normals;
}

/// Area of every triangle [m^2].
template <RealScalar S>
VectorX<S> triangle_areas(const Matrix3X<S>& positions, const Triangles& triangles) {
    return area_vectors(positions, triangles).colwise().norm().transpose();
}

/// Area-weighted unit normal of every vertex.
template <RealScalar S>
Matrix3X<S> vertex_normals(const Matrix3X<S>& positions, const Triangles& triangles) {
    const Matrix3X<S> areas = area_vectors(positions, triangles);
    Matrix3X<S> normals = Matrix3X<S>::Zero(3, positions.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        for (int k = 0; k < 3; ++k) {
            normals.col(triangles(k, t)) += areas.col(t);
        }
    }
    detail::normalise_columns(normals);
    return normals;
}

/// Volume that a closed surface encloses [m^3]; positive if the triangles face outwards.
template <RealScalar S>
S enclosed_volume(const Matrix3X<S>& positions, const Triangles& triangles) {
    const Vector3<S> origin = positions.col(0);
    const Matrix3X<S> areas = area_vectors(positions, triangles);
    S volume(0);
    for (Index t = 0; t < triangles.cols(); ++t) {
        volume += areas.col(t).dot(positions.col(triangles(0, t)) - origin) / S(3);
    }
    return volume;
}

}  // namespace softtissue
