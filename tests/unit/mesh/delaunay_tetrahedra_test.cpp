// SPDX-License-Identifier: MIT
#include <softtissue/mesh/delaunay_tetrahedra.hpp>

#include <softtissue/element/tet4.hpp>
#include <softtissue/linalg/dual_basis.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

using namespace softtissue;

namespace {

double total_volume(const Matrix3X<double>& points, const Connectivity<4>& tets) {
    double volume = 0;
    for (Index c = 0; c < tets.cols(); ++c) {
        volume += Tet4::rest_volume(CellMesh<Tet4, double>::gather(points, tets.col(c)));
    }
    return volume;
}

/// Positive tets, each face common to two at most, every point used, no point inside a sphere.
void check_delaunay(const Matrix3X<double>& points, const Connectivity<4>& tets) {
    std::map<std::array<std::int32_t, 3>, int> faces;
    std::vector<bool> used(size_t(points.cols()), false);
    Index flat = 0;
    Index invaded = 0;
    for (Index c = 0; c < tets.cols(); ++c) {
        const NodePositions<Tet4, double> x = CellMesh<Tet4, double>::gather(points, tets.col(c));
        flat += Tet4::rest_volume(x) > 0 ? 0 : 1;
        for (int k = 0; k < 4; ++k) {
            used[size_t(tets(k, c))] = true;
            std::array<std::int32_t, 3> face{tets((k + 1) % 4, c), tets((k + 2) % 4, c), tets((k + 3) % 4, c)};
            std::sort(face.begin(), face.end());
            ++faces[face];
        }
        // The circumcentre: equally far from all corners.
        const Matrix3<double> edges = x.rightCols<3>().colwise() - x.col(0);
        const Vector3<double> squares = 0.5 * edges.colwise().squaredNorm().transpose();
        const Vector3<double> centre = x.col(0) + dual_basis(edges) * squares;
        const double radius = (centre - x.col(0)).norm();
        if (radius < 0x1p28) {  // of slivers on the hull rounding leaves nothing
            for (Index v = 0; v < points.cols(); ++v) {
                invaded += (points.col(v) - centre).norm() < radius - 1.0 ? 1 : 0;
            }
        }
    }
    CHECK(flat == 0);
    CHECK(invaded == 0);
    CHECK(std::all_of(used.begin(), used.end(), [](bool u) { return u; }));
    CHECK(std::all_of(faces.begin(), faces.end(), [](const auto& face) { return face.second <= 2; }));
}

}  // namespace

TEST_CASE("random points in a cube with its corners: the cube is filled") {
    RandomGenerator random(1);
    Matrix3X<double> positions(3, 408);
    for (Index i = 0; i < positions.size(); ++i) {
        positions(i) = random.uniform();
    }
    for (Index k = 0; k < 8; ++k) {
        positions.col(k) << double(k & 1), double((k >> 1) & 1), double(k >> 2);
    }
    const Matrix3X<double> points = to_grid(positions);
    const Connectivity<4> tets = delaunay_tetrahedra(points);
    check_delaunay(points, tets);
    CHECK(total_volume(points, tets) == doctest::Approx(std::pow(0x1p24, 3)).epsilon(1e-12));
    CHECK(delaunay_tetrahedra(points) == tets);
}

TEST_CASE("a regular lattice, all of it on common planes and spheres, is filled without overlap") {
    Matrix3X<double> points(3, 125);
    for (Index k = 0; k < 125; ++k) {
        points.col(k) << double(k % 5), double(k / 5 % 5), double(k / 25);
    }
    const Connectivity<4> tets = delaunay_tetrahedra(points);
    check_delaunay(points, tets);
    CHECK(total_volume(points, tets) == doctest::Approx(64.0).epsilon(1e-12));
}

TEST_CASE("points on a sphere and a mirror image of points") {
    RandomGenerator random(2);
    Matrix3X<double> positions(3, 300);
    for (Index i = 0; i < 150; ++i) {
        positions.col(2 * i) = random_unit<Vector3<double>>(random);
        positions.col(2 * i + 1) << -positions(0, 2 * i), positions(1, 2 * i), positions(2, 2 * i);
    }
    const Matrix3X<double> points = to_grid(positions);
    const Connectivity<4> tets = delaunay_tetrahedra(points);
    check_delaunay(points, tets);
    // The hull of n points on a sphere has 2 n - 4 triangles.
    std::map<std::array<std::int32_t, 3>, int> faces;
    for (Index c = 0; c < tets.cols(); ++c) {
        for (int k = 0; k < 4; ++k) {
            std::array<std::int32_t, 3> face{tets((k + 1) % 4, c), tets((k + 2) % 4, c), tets((k + 3) % 4, c)};
            std::sort(face.begin(), face.end());
            ++faces[face];
        }
    }
    CHECK(std::count_if(faces.begin(), faces.end(), [](const auto& f) { return f.second == 1; }) == 2 * 300 - 4);
}

TEST_CASE("points that span no volume are refused") {
    Matrix3X<double> points(3, 5);
    points << 0, 1, 0, 1, 2,  //
        0, 0, 1, 1, 3,        //
        0, 0, 0, 0, 0;
    CHECK_THROWS_WITH_AS(delaunay_tetrahedra(points), "Delaunay: all points lie on one plane, expected a volume",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(delaunay_tetrahedra(points.leftCols(3)), "Delaunay: 3 points, expected at least 4",
                         InvalidInput);
    Matrix3X<double> twice(3, 6);
    twice << 0, 4, 0, 0, 1, 1,  //
        0, 0, 4, 0, 1, 1,       //
        0, 0, 0, 4, 1, 1;
    CHECK_THROWS_WITH_AS(delaunay_tetrahedra(twice),
                         "Delaunay: points 4 and 5 lie at the same place, expected distinct points", InvalidInput);
}
