// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/orthotropy_basis.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("a basis is orthonormal, right-handed, and starts with the normal", S, float, double) {
    RandomGenerator random(6);
    const S tolerance = S(8) * std::numeric_limits<S>::epsilon();
    const auto check = [&](const Vector3<S>& n) {
        const Matrix3<S> B = basis_along<S>(n);
        CHECK(B.col(0) == n);
        CHECK((B.transpose() * B - Matrix3<S>::Identity()).cwiseAbs().maxCoeff() <= tolerance);
        CHECK(B.determinant() == doctest::Approx(1.0));
    };
    for (int sample = 0; sample < 100; ++sample) {
        check(Vector3<S>(S(random.uniform(-1, 1)), S(random.uniform(-1, 1)), S(random.uniform(-1, 1))).normalized());
    }
    for (int axis = 0; axis < 3; ++axis) {
        check(Vector3<S>::Unit(axis));
        check(-Vector3<S>::Unit(axis));
    }
    check(Vector3<S>::Ones().normalized());
}

TEST_CASE_TEMPLATE("a cell takes the mean of its nodes' normals; opposed normals are refused", S, float, double) {
    Connectivity<4> cells(4, 2);
    cells << 0, 1, 1, 2, 2, 3, 3, 0;
    Matrix3X<S> normals(3, 4);
    normals << 1, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 0;
    const auto bases = orthotropy_bases<S>(cells, normals);
    REQUIRE(bases.size() == 2);
    CHECK((bases[0].col(0) - Vector3<S>(1, 1, 0).normalized()).norm() < S(1e-6));

    normals.col(2) *= S(-1);
    normals.col(3) *= S(-1);
    CHECK_THROWS_AS(orthotropy_bases<S>(cells, normals), InvalidInput);
}

TEST_CASE_TEMPLATE("every prism of a column set follows the skin above it", S, float, double) {
    SoftLayer<S> layer;
    layer.layers = {4, 2};
    layer.skin_positions.resize(3, 4);
    layer.skin_positions << 0, 1, 0, 1, 0, 0, 1, 1, 0, S(0.5), 0, S(0.5);  // the plane z = x / 2
    layer.region.triangles.resize(3, 2);
    layer.region.triangles << 0, 1, 1, 3, 2, 2;
    layer.mesh.cells = layer.layers.prisms(layer.region.triangles);
    layer.mesh.rest_positions.resize(3, layer.layers.num_vertices());
    const auto bases = orthotropy_bases(layer);
    REQUIRE(bases.size() == 4);
    for (const Matrix3<S>& B : bases) {
        CHECK((B.col(0) - Vector3<S>(S(-0.5), 0, 1).normalized()).norm() < S(1e-6));
    }
}
