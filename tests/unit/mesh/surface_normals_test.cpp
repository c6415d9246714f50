// SPDX-License-Identifier: MIT
#include <softtissue/mesh/surface_normals.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// The box [0, 2] x [0, 3] x [0, 4]; corner k has coordinate bits k & 1, k & 2, k & 4.
template <class S>
Matrix3X<S> box_corners() {
    Matrix3X<S> corners(3, 8);
    for (int k = 0; k < 8; ++k) {
        corners.col(k) << S((k & 1) != 0 ? 2 : 0), S((k & 2) != 0 ? 3 : 0), S((k & 4) != 0 ? 4 : 0);
    }
    return corners;
}

Triangles box_triangles() {
    Triangles triangles(3, 12);
    triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
        3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,           //
        1, 3, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
    return triangles;
}

}  // namespace

TEST_CASE_TEMPLATE("areas, normals and volume of a box", S, float, double) {
    const S tolerance = S(8) * std::numeric_limits<S>::epsilon();
    const Matrix3X<S> corners = box_corners<S>();
    const Triangles triangles = box_triangles();
    CHECK(enclosed_volume(corners, triangles) == doctest::Approx(24).epsilon(double(tolerance)));
    CHECK(triangle_areas(corners, triangles).sum() == doctest::Approx(52).epsilon(double(tolerance)));
    CHECK((area_vectors(corners, triangles).rowwise().sum().norm()) <= S(52) * tolerance);
    const Matrix3X<S> normals = triangle_normals(corners, triangles);
    CHECK((normals.col(0) - Vector3<S>(0, 0, -1)).norm() <= tolerance);
    CHECK((normals.col(2) - Vector3<S>(0, 0, 1)).norm() <= tolerance);

    // Corner 7 touches one or two triangles of three faces; the sum of their areas weights the axes.
    int x_faces = 0, y_faces = 0, z_faces = 0;
    for (Index t = 0; t < 12; ++t) {
        if ((triangles.col(t).array() == 7).any()) {
            x_faces += normals(0, t) > S(0.5) ? 1 : 0;
            y_faces += normals(1, t) > S(0.5) ? 1 : 0;
            z_faces += normals(2, t) > S(0.5) ? 1 : 0;
        }
    }
    const Vector3<S> weighted = Vector3<S>(S(6 * x_faces), S(4 * y_faces), S(3 * z_faces)).normalized();
    CHECK((vertex_normals(corners, triangles).col(7) - weighted).norm() <= tolerance);
}

TEST_CASE("a triangle without area has a zero normal") {
    Matrix3X<double> line(3, 3);
    line << 0, 1, 2, 0, 0, 0, 0, 0, 0;
    Triangles triangle(3, 1);
    triangle << 0, 1, 2;
    CHECK(triangle_normals(line, triangle).norm() == 0.0);
    CHECK(vertex_normals(line, triangle).norm() == 0.0);
}
