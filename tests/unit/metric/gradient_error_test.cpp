// SPDX-License-Identifier: MIT
#include <softtissue/metric/gradient_error.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// Two prisms, one on top of the other.
template <class S>
CellMesh<Prism6, S> two_prisms() {
    CellMesh<Prism6, S> mesh{Matrix3X<S>(3, 9), Connectivity<6>(6, 2)};
    mesh.rest_positions << 0, 1, 0, 0, 1, 0, S(0.5), S(1.5), S(0.25),  //
        0, 0, 1, 0, 0, 1, 0, S(0.25), 1,                               //
        0, 0, 0, 1, 1, 1, 2, 2, S(2.5);
    mesh.cells << 0, 3, 1, 4, 2, 5, 3, 6, 4, 7, 5, 8;
    return mesh;
}

}  // namespace

TEST_CASE_TEMPLATE("two affine motions differ by the mean square of the nine entries", S, float, double) {
    const CellMesh<Prism6, S> mesh = two_prisms<S>();
    const auto operators = RestOperators<Prism6, S>::at(mesh, mesh.rest_positions);
    RandomGenerator random(1);
    const Matrix3<S> A = random_normal<Matrix3<S>>(random);
    const Matrix3<S> B = random_normal<Matrix3<S>>(random);
    const Vector3<S> t(1, 2, 3);
    const Matrix3X<S> x = A * mesh.rest_positions;
    const Matrix3X<S> reference = (B * mesh.rest_positions).colwise() + t;
    CHECK(gradient_error(mesh, operators, x, reference) ==
          doctest::Approx(double((A - B).squaredNorm()) / 9).epsilon(1e-5));
    CHECK(gradient_error(mesh, operators, x, x) == S(0));
}

TEST_CASE("any motion: the gradients of both, formed and compared one by one") {
    const CellMesh<Prism6, double> mesh = two_prisms<double>();
    const auto operators = RestOperators<Prism6, double>::at(mesh, mesh.rest_positions);
    RandomGenerator random(2);
    const Matrix3X<double> x = Matrix3X<double>::NullaryExpr(3, 9, [&random] { return random.normal(); });
    const Matrix3X<double> reference = Matrix3X<double>::NullaryExpr(3, 9, [&random] { return random.normal(); });
    double sum = 0;
    for (Index c = 0; c < 2; ++c) {
        Matrix3<double> F = Matrix3<double>::Zero();
        Matrix3<double> F_reference = Matrix3<double>::Zero();
        for (int i = 0; i < 6; ++i) {
            F += x.col(mesh.cells(i, c)) * operators.gradients.col(6 * c + i).transpose();
            F_reference += reference.col(mesh.cells(i, c)) * operators.gradients.col(6 * c + i).transpose();
        }
        sum += (F - F_reference).squaredNorm();
    }
    CHECK(gradient_error(mesh, operators, x, reference) == doctest::Approx(sum / 18).epsilon(1e-12));
}

TEST_CASE("no cells give 0; unequal sizes are refused") {
    CellMesh<Tet4, double> mesh{Matrix3X<double>::Zero(3, 2), Connectivity<4>(4, 0)};
    const auto operators = RestOperators<Tet4, double>::at(mesh, mesh.rest_positions);
    CHECK(gradient_error(mesh, operators, mesh.rest_positions, mesh.rest_positions) == 0);
    const Matrix3X<double> three = Matrix3X<double>::Zero(3, 3);
    CHECK_THROWS_WITH_AS(gradient_error(mesh, operators, mesh.rest_positions, three),
                         "gradient error: 2 positions and 3 reference positions, expected 2", InvalidInput);
    RestOperators<Tet4, double> other = operators;
    other.volumes.resize(1);
    CHECK_THROWS_WITH_AS(gradient_error(mesh, other, three, three), "gradient error: operators of 1 cells, expected 0",
                         InvalidInput);
}
