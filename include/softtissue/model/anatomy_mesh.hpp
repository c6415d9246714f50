// SPDX-License-Identifier: MIT
/// @file
/// A named bone or muscle as a triangle surface, and the one way in which the procedural ones are made: lofts.
///
/// What        AnatomyMesh; add_loft(): appends a closed surface through rings of points between two poles.
/// Shapes      positions 3 x n [m]; triangles 3 x m facing outwards. A mesh may consist of several closed pieces that overlap.
/// Valid       point(u, angle) is continuous, periodic in the angle, and one point at u = 0 and at u = 1.
/// Tests       tests/unit/model/anatomy_mesh_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace softtissue {

enum class AnatomyKind { bone, muscle };

template <RealScalar S>
struct AnatomyMesh {
    std::string name;
    AnatomyKind kind;
    Matrix3X<S> positions;
    Triangles triangles;
};

/// Appends point(u, angle) on `rings` rings of `sectors` points and the two poles; u is denser towards the poles. A body
/// has many lofts, each made once: a function object, so that this is compiled once.
inline void add_loft(AnatomyMesh<double>& mesh, Index rings, Index sectors,
                     const std::function<Vector3<double>(double, double)>& point) {
    const double pi = std::numbers::pi;
    Matrix3X<double> positions(3, rings * sectors + 2);
    for (Index r = 0; r < rings; ++r) {
        const double u = 0.5 - 0.5 * std::cos(pi * double(r + 1) / double(rings + 1));
        for (Index k = 0; k < sectors; ++k) {
            positions.col(r * sectors + k) = point(u, 2.0 * pi * double(k) / double(sectors));
        }
    }
    const auto first_pole = static_cast<std::int32_t>(rings * sectors);
    positions.col(first_pole) = point(0.0, 0.0);
    positions.col(first_pole + 1) = point(1.0, 0.0);
    Triangles triangles(3, 2 * rings * sectors);
    Index t = 0;
    for (Index k = 0; k < sectors; ++k) {
        const auto vertex = [&](Index r, Index sector) {
            return static_cast<std::int32_t>(r * sectors + sector % sectors);
        };
        triangles.col(t++) << first_pole, vertex(0, k + 1), vertex(0, k);
        triangles.col(t++) << first_pole + 1, vertex(rings - 1, k), vertex(rings - 1, k + 1);
        for (Index r = 0; r + 1 < rings; ++r) {
            triangles.col(t++) << vertex(r, k), vertex(r, k + 1), vertex(r + 1, k + 1);
            triangles.col(t++) << vertex(r, k), vertex(r + 1, k + 1), vertex(r + 1, k);
        }
    }
    if (enclosed_volume(positions, triangles) < 0.0) {  // the chart that `point` comes from is left-handed
        triangles.row(1).swap(triangles.row(2));
    }
    const Index num_before = mesh.positions.cols();
    const Index triangles_before = mesh.triangles.cols();
    mesh.positions.conservativeResize(3, num_before + positions.cols());
    mesh.positions.rightCols(positions.cols()) = positions;
    mesh.triangles.conservativeResize(3, triangles_before + triangles.cols());
    mesh.triangles.rightCols(triangles.cols()) = triangles.array() + static_cast<std::int32_t>(num_before);
}

/// Values at u in [0, 1] of a smooth curve through evenly spaced rows (Catmull, Rom).
template <int size>
Eigen::Matrix<double, size, 1> along_stations(const std::vector<Eigen::Matrix<double, size, 1>>& stations, double u) {
    const auto last = static_cast<Index>(stations.size()) - 1;
    const double place = std::clamp(u, 0.0, 1.0) * double(last);
    const Index i = std::min(Index(place), std::max(last - 1, Index(0)));
    const auto at = [&](Index k) -> const Eigen::Matrix<double, size, 1>& {
        return stations[size_t(std::clamp(k, Index(0), last))];
    };
    const double t = place - double(i);
    return 0.5 * (2.0 * at(i) + t * (at(i + 1) - at(i - 1)) +
                  t * t * (2.0 * at(i - 1) - 5.0 * at(i) + 4.0 * at(i + 1) - at(i + 2)) +
                  t * t * t * (3.0 * at(i) - at(i - 1) - 3.0 * at(i + 1) + at(i + 2)));
}

/// Rises from 0 at the ends of [0, 1] like a circle of the given width, 1 between.
inline double rounded_ends(double u, double width) {
    const double d = std::min({u / width, (1.0 - u) / width, 1.0});
    return std::sqrt(std::max(0.0, 1.0 - (1.0 - d) * (1.0 - d)));
}

}  // namespace softtissue
