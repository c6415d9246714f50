// SPDX-License-Identifier: MIT
#include <softtissue/mesh/laplacian.hpp>

#include <softtissue/testing/random_states.hpp>
#include <support/reference_case.hpp>
#include <unit/mesh/small_meshes.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Sparse = Eigen::SparseMatrix<double>;

VectorX<double> random_vector(RandomGenerator& random, Index size) {
    return VectorX<double>::NullaryExpr(size, [&random] { return random.normal(); });
}

/// w^T L w = int |grad w|^2 for w = slope . x on a mesh of area or volume `measure`.
void check_linear_energy(const Sparse& L, const Matrix3X<double>& X, const Vector3<double>& slope, double measure) {
    const VectorX<double> w = X.transpose() * slope;
    const VectorX<double> Lw = L * w;
    CHECK(w.dot(Lw) == doctest::Approx(slope.squaredNorm() * measure).epsilon(1e-12));
}

}  // namespace

TEST_CASE_TEMPLATE("an equilateral triangle, by hand: cot 60 / 2 = 0.2887", Scalar, float, double) {
    Matrix3X<Scalar> X(3, 3);
    X << 0, 1, Scalar(0.5),              //
        0, 0, std::sqrt(Scalar(3)) / 2,  //
        0, 0, 0;
    Triangles triangle(3, 1);
    triangle << 0, 1, 2;
    const MatrixX<Scalar> L = cotangent_laplacian<Scalar>(X, triangle);
    const Scalar weight = 1 / (2 * std::sqrt(Scalar(3)));
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            CHECK(double(L(i, j)) == doctest::Approx(double(i == j ? 2 * weight : -weight)));
        }
    }
    const Scalar third = std::sqrt(Scalar(3)) / 12;
    const VectorX<Scalar> voronoi = voronoi_masses<Scalar>(X, triangle);
    const VectorX<Scalar> barycentric = barycentric_masses<Scalar>(X, triangle);
    for (int i = 0; i < 3; ++i) {
        CHECK(double(voronoi(i)) == doctest::Approx(double(third)));
        CHECK(double(barycentric(i)) == doctest::Approx(double(third)));
    }
}

TEST_CASE(
    "an obtuse triangle gives half of its area to the obtuse corner and a negative weight to the side facing it") {
    Matrix3X<double> X(3, 3);
    X << 0, 4, 1,  //
        0, 0, 1,   //
        0, 0, 0;
    Triangles triangle(3, 1);
    triangle << 0, 1, 2;
    const VectorX<double> masses = voronoi_masses(X, triangle);
    CHECK(masses(0) == doctest::Approx(0.5));
    CHECK(masses(1) == doctest::Approx(0.5));
    CHECK(masses(2) == doctest::Approx(1));
    CHECK(cotangent_laplacian(X, triangle).coeff(0, 1) > 0);
}

TEST_CASE("the operator of a bent surface is symmetric, positive semi-definite and blind to constants") {
    RandomGenerator random(1);
    SquareMesh square = make_square(7);
    for (Index v = 0; v < square.positions.cols(); ++v) {
        square.positions.col(v) += 0.02 * random_normal<Vector3<double>>(random);
    }
    const Sparse L = cotangent_laplacian(square.positions, square.triangles);
    const Sparse transposed = L.transpose();
    CHECK((L - transposed).norm() == 0);
    const VectorX<double> ones = VectorX<double>::Ones(L.cols());
    CHECK((L * ones).norm() < 1e-13 * L.norm());
    for (int sample = 0; sample < 100; ++sample) {
        const VectorX<double> w = random_vector(random, L.cols());
        const VectorX<double> Lw = L * w;
        CHECK(w.dot(Lw) > 0);
    }
    CHECK(voronoi_masses(square.positions, square.triangles).sum() ==
          doctest::Approx(barycentric_masses(square.positions, square.triangles).sum()).epsilon(1e-14));
}

TEST_CASE("linear functions have the exact energy, on a flat surface and in a volume") {
    RandomGenerator random(2);
    SquareMesh square = make_square(6);
    check_linear_energy(cotangent_laplacian(square.positions, square.triangles), square.positions, {0.3, -0.7, 0}, 1);
    const CellMesh<Tet4, double> cube = make_cube(4, random);
    const Sparse L = cotangent_laplacian(cube);
    check_linear_energy(L, cube.rest_positions, {0.3, -0.7, 1.1}, 1);
    CHECK(barycentric_masses(cube).sum() == doctest::Approx(1).epsilon(1e-14));
    const Sparse transposed = L.transpose();
    CHECK((L - transposed).norm() == 0);
}

TEST_CASE("the bilaplacian is the squared Laplacian, integrated") {
    const SquareMesh square = make_square(5);
    const Sparse L = cotangent_laplacian(square.positions, square.triangles);
    const VectorX<double> masses = voronoi_masses(square.positions, square.triangles);
    RandomGenerator random(3);
    const VectorX<double> w = random_vector(random, L.cols());
    const VectorX<double> Lw = L * w;
    const VectorX<double> Qw = bilaplacian(L, masses) * w;
    CHECK(w.dot(Qw) == doctest::Approx(Lw.cwiseAbs2().cwiseQuotient(masses).sum()).epsilon(1e-12));
}

TEST_CASE("cells and masses that cannot be worked with are named") {
    SquareMesh square = make_square(2);
    const auto laplacian = [&] { return cotangent_laplacian(square.positions, square.triangles); };
    SUBCASE("index out of range") {
        square.triangles(1, 3) = 9;
        CHECK_THROWS_WITH_AS(laplacian(), "laplacian: triangle 3 uses vertex 9, expected 0 to 8", InvalidInput);
    }
    SUBCASE("triangle without area") {
        square.triangles(1, 2) = square.triangles(0, 2);
        CHECK_THROWS_WITH_AS(laplacian(), "laplacian: triangle 2 has area 0, expected > 0", InvalidInput);
        CHECK_THROWS_AS(voronoi_masses(square.positions, square.triangles), InvalidInput);
        CHECK_THROWS_AS(barycentric_masses(square.positions, square.triangles), InvalidInput);
    }
    SUBCASE("position not finite") {
        square.positions(0, 0) = std::numeric_limits<double>::quiet_NaN();
        CHECK_THROWS_AS(laplacian(), InvalidInput);
    }
    SUBCASE("inverted tet") {
        RandomGenerator random(4);
        CellMesh<Tet4, double> cube = make_cube(1, random);
        cube.cells.col(1).head<2>().reverseInPlace();
        CHECK_THROWS_WITH_AS(cotangent_laplacian(cube), doctest::Contains("laplacian: tet 1 has volume -0.16"),
                             InvalidInput);
        CHECK_THROWS_AS(barycentric_masses(cube), InvalidInput);
    }
    SUBCASE("mass of a vertex without triangles") {
        VectorX<double> masses = voronoi_masses(square.positions, square.triangles);
        masses(4) = 0;
        CHECK_THROWS_WITH_AS(bilaplacian(laplacian(), masses), "bilaplacian: mass of vertex 4 is 0, expected > 0",
                             InvalidInput);
        CHECK_THROWS_WITH_AS(bilaplacian(laplacian(), masses.head(3)), "bilaplacian: 3 masses, expected 9",
                             InvalidInput);
    }
}

#if __has_include(<zip.h>)
namespace {

/// Largest difference to the stored operator (of the other sign), relative to its largest entry.
double operator_error(const Sparse& L, const NpzFile& file) {
    const MatrixX<std::int32_t> at = file.at("L_ij").matrix<std::int32_t>();
    const VectorX<double> values = file.at("L_val").vector<double>();
    MatrixX<double> sum = L;
    for (Index k = 0; k < values.size(); ++k) {
        sum(at(k, 0), at(k, 1)) += values(k);
    }
    return sum.cwiseAbs().maxCoeff() / values.cwiseAbs().maxCoeff();
}

double relative_error(const VectorX<double>& computed, const NpzFile& file, const char* name) {
    const VectorX<double> expected = file.at(name).vector<double>();
    return (computed - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("agrees with an independent program on a closed surface") {
    if (const std::optional<NpzFile> file = reference_case("o6_tri.npz")) {
        const Matrix3X<double> X = file->at("V").columns3<double>();
        const Triangles triangles = file->at("F").columns<std::int32_t, 3>();
        CHECK(operator_error(cotangent_laplacian(X, triangles), *file) < 1e-14);
        CHECK(relative_error(voronoi_masses(X, triangles), *file, "M_voronoi") < 1e-14);
        CHECK(relative_error(barycentric_masses(X, triangles), *file, "M_barycentric") < 1e-14);
    }
}

TEST_CASE("agrees with an independent program on a tet mesh") {
    if (const std::optional<NpzFile> file = reference_case("o6_tet.npz")) {
        const CellMesh<Tet4, double> mesh{file->at("X").columns3<double>(), file->at("T").columns<std::int32_t, 4>()};
        CHECK(operator_error(cotangent_laplacian(mesh), *file) < 1e-13);
        CHECK(relative_error(barycentric_masses(mesh), *file, "M_barycentric") < 1e-14);
    }
}
#endif
