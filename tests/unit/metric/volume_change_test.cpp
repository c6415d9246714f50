// SPDX-License-Identifier: MIT
#include <softtissue/metric/volume_change.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

template <class S>
CellMesh<Prism6, S> two_prisms() {
    CellMesh<Prism6, S> mesh{Matrix3X<S>(3, 9), Connectivity<6>(6, 2)};
    mesh.rest_positions << 0, 1, 0, 0, 1, 0, S(0.5), S(1.5), S(0.25),  //
        0, 0, 1, 0, 0, 1, 0, S(0.25), 1,                               //
        0, 0, 0, 1, 1, 1, 2, 2, S(2.5);
    mesh.cells << 0, 3, 1, 4, 2, 5, 3, 6, 4, 7, 5, 8;
    return mesh;
}

/// The volume inside the bilinear sides: the flux of X/3 through fine triangles on them and on both ends.
double volume_by_flux(const Prism6::Nodes<double>& X) {
    double volume = 0;
    const auto add = [&volume](const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c) {
        volume += a.dot(b.cross(c)) / 6;
    };
    for (const ElementFace& face : Prism6::faces) {
        if (face.num_nodes == 3) {
            add(X.col(face.nodes[0]), X.col(face.nodes[1]), X.col(face.nodes[2]));
            continue;
        }
        constexpr int n = 100;
        const auto at = [&](int i, int j) {
            const double u = double(i) / n;
            const double v = double(j) / n;
            return Vector3<double>((1 - u) * (1 - v) * X.col(face.nodes[0]) + u * (1 - v) * X.col(face.nodes[1]) +
                                   u * v * X.col(face.nodes[2]) + (1 - u) * v * X.col(face.nodes[3]));
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
                add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
            }
        }
    }
    return volume;
}

}  // namespace

TEST_CASE_TEMPLATE("an affine motion changes every cell by its determinant", S, float, double) {
    const CellMesh<Prism6, S> mesh = two_prisms<S>();
    Matrix3<S> A;
    A << 2, 1, 0, 0, 1, 1, 0, 0, S(0.75);
    const VolumeChange<S> change = volume_change(mesh, Matrix3X<S>(A * mesh.rest_positions));
    CHECK(change.relative(0) == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(change.relative(1) == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(change.mean_square == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(change.sum_of_squares == doctest::Approx(0.5).epsilon(1e-5));
    CHECK(change.num_inverted == 0);

    const VolumeChange<S> mirrored = volume_change(mesh, Matrix3X<S>(-mesh.rest_positions));
    CHECK(mirrored.num_inverted == 2);
    CHECK(mirrored.relative(0) == doctest::Approx(-2).epsilon(1e-6));
    CHECK(volume_change(mesh, mesh.rest_positions).sum_of_squares == S(0));
}

TEST_CASE("twisted prisms: the exact volume between curved sides") {
    const CellMesh<Prism6, double> mesh = two_prisms<double>();
    RandomGenerator random(3);
    Matrix3X<double> x = mesh.rest_positions;
    for (Index v = 0; v < x.cols(); ++v) {
        x.col(v) += 0.2 * random_normal<Vector3<double>>(random);
    }
    const VolumeChange<double> change = volume_change(mesh, x);
    for (Index c = 0; c < 2; ++c) {
        const double expected =
            volume_by_flux(mesh.gather(x, mesh.cells.col(c))) / volume_by_flux(mesh.rest_nodes(c)) - 1;
        CHECK(std::abs(change.relative(c) - expected) < 1e-4);  // of the triangles on the curved sides
    }
    CHECK(change.sum_of_squares == doctest::Approx(change.relative.squaredNorm()).epsilon(1e-12));
}

TEST_CASE("one of two tets is pushed through the other") {
    CellMesh<Tet4, double> mesh{Matrix3X<double>(3, 5), Connectivity<4>(4, 2)};
    mesh.rest_positions << 0, 1, 0, 0, 1,  //
        0, 0, 1, 0, 1,                     //
        0, 0, 0, 1, 1;
    mesh.cells << 0, 1, 1, 2, 2, 3, 3, 4;
    Matrix3X<double> x = mesh.rest_positions;
    x.col(4) << 0.5, 0.25, 0.25;  // onto the common triangle: volume 0 is not negative
    CHECK(volume_change(mesh, x).num_inverted == 0);
    CHECK(volume_change(mesh, x).relative(1) == doctest::Approx(-1));
    x.col(4).setConstant(0.1);
    CHECK(volume_change(mesh, x).num_inverted == 1);
    CHECK(volume_change(mesh, x).relative(0) == 0);

    CHECK_THROWS_WITH_AS(volume_change(mesh, Matrix3X<double>(x.leftCols(4))), "volume change: 4 positions, expected 5",
                         InvalidInput);
    mesh.cells.col(1).head<2>().reverseInPlace();
    CHECK_THROWS_AS(volume_change(mesh, x), InvalidInput);
}

TEST_CASE("no cells change by nothing") {
    const CellMesh<Tet4, float> mesh{Matrix3X<float>::Zero(3, 2), Connectivity<4>(4, 0)};
    const VolumeChange<float> change = volume_change(mesh, mesh.rest_positions);
    CHECK(change.mean_square == 0.0F);
    CHECK(change.relative.size() == 0);
}
