// SPDX-License-Identifier: MIT
#include <softtissue/element/tet4.hpp>

#include <softtissue/element/concepts.hpp>
#include <softtissue/testing/random_states.hpp>
#include <support/reference_case.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

static_assert(Element<Tet4, float> && Element<Tet4, double>);

namespace {

template <class Scalar>
NodePositions<Tet4, Scalar> unit_tet() {
    NodePositions<Tet4, Scalar> X;
    X << 0, 1, 0, 0,  //
        0, 0, 1, 0,   //
        0, 0, 0, 1;
    return X;
}

}  // namespace

TEST_CASE_TEMPLATE("the unit tet, by hand", Scalar, float, double) {
    const NodePositions<Tet4, Scalar> X = unit_tet<Scalar>();
    CHECK(Tet4::rest_volume(X) == Scalar(1) / Scalar(6));
    CHECK(Tet4::smallest_jacobian_bound(X) == Scalar(1));
    NodePositions<Tet4, Scalar> g;
    g << -1, 1, 0, 0,  //
        -1, 0, 1, 0,   //
        -1, 0, 0, 1;
    CHECK(Tet4::gradient_operator(X) == g);
    CHECK(Tet4::shape_integrals(X) == NodeValues<Tet4, Scalar>::Constant(Scalar(1) / Scalar(24)));
}

TEST_CASE("swapping two nodes turns a tet inside out; every even permutation keeps it") {
    const NodePositions<Tet4, double> X = unit_tet<double>();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
            NodePositions<Tet4, double> swapped = X;
            swapped.col(i).swap(swapped.col(j));
            CHECK(Tet4::rest_volume(swapped) == -Tet4::rest_volume(X));
        }
    }
    for (const std::array<int, 4>& order : Tet4::symmetries) {
        NodePositions<Tet4, double> permuted;
        for (int k = 0; k < 4; ++k) {
            permuted.col(k) = X.col(order[std::size_t(k)]);
        }
        CHECK(Tet4::rest_volume(permuted) == Tet4::rest_volume(X));
    }
}

TEST_CASE("a point outside has a negative barycentric coordinate; a flat tet has no inverse map") {
    NodePositions<Tet4, double> X = unit_tet<double>();
    const NaturalCoordinates<double> outside = Tet4::natural_coordinates<double>(X, {0.25, 0.5, -0.125});
    CHECK(outside.converged);
    CHECK(outside.coordinates == Vector3<double>(0.25, 0.5, -0.125));
    X.row(2).setZero();
    CHECK_FALSE(Tet4::natural_coordinates<double>(X, {0.25, 0.25, 0}).converged);
}

TEST_CASE_TEMPLATE("irregular tets give the gradient of an affine map exactly", Scalar, float, double) {
    RandomGenerator random(11);
    double worst = 0;
    for (int sample = 0; sample < 200; ++sample) {
        const NodePositions<Tet4, Scalar> X =
            unit_tet<Scalar>() + Scalar(0.1) * random_normal<NodePositions<Tet4, Scalar>>(random);
        const Matrix3<Scalar> A = random_normal<Matrix3<Scalar>>(random);
        const Vector3<Scalar> shift = random_normal<Vector3<Scalar>>(random);
        const NodePositions<Tet4, Scalar> g = Tet4::gradient_operator(X);
        const NodePositions<Tet4, Scalar> x = (A * X).colwise() + shift;
        const Matrix3<Scalar> F = x * g.transpose();
        worst = std::max(worst, double((F - A).norm() / (x.norm() * g.norm())));
    }
    CHECK(worst < 20 * double(std::numeric_limits<Scalar>::epsilon()));
}

#if __has_include(<zip.h>)
TEST_CASE("agrees with an independent computation to 1e-12") {
    const std::optional<NpzFile> file = softtissue_test::reference_case("o2_tet.npz");
    if (!file) {
        return;
    }
    const auto X = file->at("X").matrices<double, 4, 3>();
    const auto g = file->at("g").matrices<double, 4, 3>();
    const auto phi = file->at("phi").matrices<double, 4, 3>();
    const auto F = file->at("F").matrices<double, 3, 3>();
    const VectorX<double> volume = file->at("volume").vector<double>();
    for (std::size_t c = 0; c < X.size(); ++c) {
        CAPTURE(c);
        const NodePositions<Tet4, double> nodes = X[c].transpose();
        const NodePositions<Tet4, double> operator_g = Tet4::gradient_operator(nodes);
        CHECK(std::abs(Tet4::rest_volume(nodes) / volume(Index(c)) - 1) < 1e-12);
        CHECK((operator_g - g[c].transpose()).norm() < 1e-12 * g[c].norm());
        const NodePositions<Tet4, double> x = (phi[c].rowwise() - phi[c].row(0)).transpose();
        CHECK((x * operator_g.transpose() - F[c]).norm() < 1e-12 * F[c].norm());
    }
}
#endif
