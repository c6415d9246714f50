// SPDX-License-Identifier: MIT
/// @file
/// Triangles over points, while they are being made.
///
/// What        growable vertex and triangle lists; the finished body stores Matrix3X and Triangles instead.
/// Shapes      positions [m]; each triangle three vertex numbers, counter-clockwise seen from outside.
/// Tests       tests/unit/model/surface_mesh_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace softtissue {

struct SurfaceMesh {
    std::vector<Vector3<double>> vertices;
    std::vector<std::array<int, 3>> triangles;

    /// Twice the area times the outward normal of triangle t.
    Vector3<double> normal(size_t t) const {
        const std::array<int, 3>& v = triangles[t];
        const Vector3<double>& a = vertices[size_t(v[0])];
        return (vertices[size_t(v[1])] - a).cross(vertices[size_t(v[2])] - a);
    }
};

}  // namespace softtissue
