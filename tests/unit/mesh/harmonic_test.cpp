// SPDX-License-Identifier: MIT
#include <softtissue/mesh/harmonic.hpp>

#include <softtissue/mesh/laplacian.hpp>
#include <support/reference_case.hpp>
#include <unit/mesh/small_meshes.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Interpolation = HarmonicInterpolation<double>;
using Sparse = Eigen::SparseMatrix<double>;

MatrixX<double> random_matrix(RandomGenerator& random, Index rows, Index cols) {
    return MatrixX<double>::NullaryExpr(rows, cols, [&random] { return random.normal(); });
}

/// The rows of `all` that belong to `vertices`, `components` rows a vertex.
MatrixX<double> rows_of(const MatrixX<double>& all, const std::vector<std::int32_t>& vertices, Index components) {
    MatrixX<double> rows(components * Index(vertices.size()), all.cols());
    for (size_t i = 0; i < vertices.size(); ++i) {
        rows.middleRows(components * Index(i), components) = all.middleRows(components * vertices[i], components);
    }
    return rows;
}

/// Energy of a chain of springs 0 - 1 - ... - n-1, and of separate chains where `cut` says.
Sparse chain(Index n, Index cut = -1) {
    Sparse L(n, n);
    for (Index v = 0; v + 1 < n; ++v) {
        if (v != cut) {
            L.coeffRef(v, v) += 1;
            L.coeffRef(v + 1, v + 1) += 1;
            L.coeffRef(v, v + 1) -= 1;
            L.coeffRef(v + 1, v) -= 1;
        }
    }
    return L;
}

}  // namespace

TEST_CASE_TEMPLATE("on a chain values run straight from one end to the other", Scalar, float, double) {
    const Eigen::SparseMatrix<Scalar> L = chain(5).cast<Scalar>();
    const std::vector<std::int32_t> ends{4, 0};
    const HarmonicInterpolation<Scalar> interpolation(L, ends);
    CHECK(interpolation.num_vertices() == 5);
    CHECK(interpolation.num_prescribed() == 2);
    MatrixX<Scalar> values(2, 1);
    values << 8, 0;
    const MatrixX<Scalar> w = interpolation.interpolate(values);
    CHECK(w(0) == Scalar(0));
    CHECK(w(4) == Scalar(8));
    for (int v = 1; v < 4; ++v) {
        CHECK(w(v) == doctest::Approx(2 * v));
    }
}

TEST_CASE("linear functions in a volume are reproduced, values between prescribed ones stay there") {
    RandomGenerator random(1);
    const CellMesh<Tet4, double> cube = make_cube(5, random);
    const std::vector<std::int32_t> surface = cube_surface(cube);
    const Interpolation interpolation(cotangent_laplacian(cube), surface);
    REQUIRE(interpolation.num_prescribed() < cube.num_vertices());
    const MatrixX<double> linear = (cube.rest_positions.transpose() * random_matrix(random, 3, 2)).array() + 1;
    const MatrixX<double> w = interpolation.interpolate(rows_of(linear, surface, 1));
    CHECK((w - linear).norm() < 1e-13 * linear.norm());
}

TEST_CASE("without obtuse angles values stay within the range of those prescribed") {
    const SquareMesh square = make_square(8);
    RandomGenerator random(2);
    const Sparse L = cotangent_laplacian(square.positions, square.triangles);
    const std::vector<std::int32_t> some{0, 8, 40, 44, 80};
    const MatrixX<double> values = random_matrix(random, 5, 20);
    const MatrixX<double> w = Interpolation(L, some).interpolate(values);
    for (Index k = 0; k < 20; ++k) {
        CHECK(w.col(k).maxCoeff() <= values.col(k).maxCoeff() + 1e-14);
        CHECK(w.col(k).minCoeff() >= values.col(k).minCoeff() - 1e-14);
    }
}

TEST_CASE("the result has the smallest energy of all with these prescribed values, harmonic and biharmonic") {
    const SquareMesh square = make_square(6);
    const Sparse L = cotangent_laplacian(square.positions, square.triangles);
    const Sparse biharmonic = bilaplacian(L, voronoi_masses(square.positions, square.triangles));
    const std::vector<std::int32_t> some{3, 20, 41};
    RandomGenerator random(3);
    for (const Sparse& energy : {L, biharmonic}) {
        const MatrixX<double> w = Interpolation(energy, some).interpolate(random_matrix(random, 3, 1));
        // No force on free vertices is exactly that, the energy being convex.
        VectorX<double> force = energy * w;
        const double size = force.cwiseAbs().maxCoeff();
        for (const std::int32_t v : some) {
            force(v) = 0;
        }
        CHECK(force.cwiseAbs().maxCoeff() < 1e-11 * size);
    }
}

TEST_CASE("several numbers a vertex are interpolated as if each came alone") {
    const SquareMesh square = make_square(4);
    const Interpolation interpolation(cotangent_laplacian(square.positions, square.triangles),
                                      std::vector<std::int32_t>{0, 12, 24});
    RandomGenerator random(4);
    const MatrixX<double> values = random_matrix(random, 9, 2);
    const MatrixX<double> w = interpolation.interpolate(values);
    REQUIRE(w.rows() == 75);
    for (Index d = 0; d < 3; ++d) {
        MatrixX<double> alone(3, 2);
        alone << values.row(d), values.row(3 + d), values.row(6 + d);
        const MatrixX<double> expected = interpolation.interpolate(alone);
        for (Index v = 0; v < 25; ++v) {
            CHECK(w.row(3 * v + d) == expected.row(v));
        }
    }
}

TEST_CASE("sparse values give the same, less what is small") {
    const SquareMesh square = make_square(6);
    const std::vector<std::int32_t> some{0, 6, 24, 42, 48};
    const Interpolation interpolation(cotangent_laplacian(square.positions, square.triangles), some);
    RandomGenerator random(5);
    MatrixX<double> values = MatrixX<double>::Zero(15, 100);  // more columns than are solved at a time
    for (Index k = 0; k < 100; k += 2) {
        values(random.index(15), k) = random.normal();
    }
    const MatrixX<double> dense = interpolation.interpolate(values);
    const Sparse sparse_values = values.sparseView();
    const Sparse all = interpolation.interpolate(sparse_values, 0);
    CHECK(MatrixX<double>(all) == dense);

    const double smallest = 0.05;
    const Sparse kept = interpolation.interpolate(sparse_values, smallest);
    CHECK(kept.nonZeros() < all.nonZeros());
    CHECK((MatrixX<double>(kept) - dense).cwiseAbs().maxCoeff() <= smallest);
    CHECK(rows_of(kept, some, 3) == values);
}

TEST_CASE("with every vertex prescribed the values are only sorted") {
    const Interpolation interpolation(chain(3), std::vector<std::int32_t>{2, 0, 1});
    MatrixX<double> values(3, 1);
    values << 20, 0, 10;
    CHECK(interpolation.interpolate(values) == Vector3<double>(0, 10, 20));
}

TEST_CASE("an interpolation can be moved") {
    Interpolation first(chain(3), std::vector<std::int32_t>{0, 2});
    const Interpolation second = std::move(first);
    MatrixX<double> values(2, 1);
    values << 0, 2;
    CHECK(second.interpolate(values)(1) == doctest::Approx(1));
}

TEST_CASE("prescribed vertices and values that do not fit are named") {
    using Vertices = std::vector<std::int32_t>;
    CHECK_THROWS_WITH_AS(Interpolation(chain(4), Vertices{}),
                         "interpolation: no vertex is prescribed, expected at least one", InvalidInput);
    CHECK_THROWS_WITH_AS(Interpolation(chain(4), Vertices{0, 4}), "interpolation: prescribed vertex 4, expected 0 to 3",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(Interpolation(chain(4), Vertices{2, 2}), "interpolation: vertex 2 is prescribed twice",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(Interpolation(chain(4, 1), Vertices{0}),
                         "interpolation: vertex 2 is not connected to any prescribed vertex", InvalidInput);
    CHECK_THROWS_WITH_AS(Interpolation(Sparse(2, 3), Vertices{0}),
                         "interpolation: energy is 2 x 3, expected a square matrix", InvalidInput);
    const Interpolation interpolation(chain(4), Vertices{0, 3});
    CHECK_THROWS_WITH_AS(interpolation.interpolate(MatrixX<double>::Zero(3, 1)),
                         "interpolation: values have 3 rows, expected a multiple of the 2 prescribed vertices",
                         InvalidInput);
    MatrixX<double> values = MatrixX<double>::Zero(6, 2);
    values(4, 1) = std::nan("");
    CHECK_THROWS_WITH_AS(interpolation.interpolate(values),
                         "interpolation: a value of prescribed vertex 3 is not finite", InvalidInput);
}

TEST_CASE("an energy that is not positive semi-definite is refused") {
    const Sparse negative = -1.0 * chain(4);
    CHECK_THROWS_WITH_AS(Interpolation(negative, std::vector<std::int32_t>{0}),
                         "interpolation: the energy of the free vertices is not positive definite", InvalidInput);
    Sparse broken = chain(4);
    broken.coeffRef(2, 2) = std::nan("");
    CHECK_THROWS_AS(Interpolation(broken, std::vector<std::int32_t>{0}), InvalidInput);
}

#if __has_include(<zip.h>)
namespace {

double error(const Sparse& energy, const NpzFile& file, const char* name) {
    const MatrixX<double> w =
        Interpolation(energy, file.at("b").as<std::int32_t>()).interpolate(file.at("bc").matrix<double>());
    const MatrixX<double> expected = file.at(name).matrix<double>();
    return (w - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("agrees with an independent program on a closed surface") {
    if (const std::optional<NpzFile> file = reference_case("o6_tri.npz")) {
        const Matrix3X<double> X = file->at("V").columns3<double>();
        const Triangles triangles = file->at("F").columns<std::int32_t, 3>();
        const Sparse L = cotangent_laplacian(X, triangles);
        CHECK(error(L, *file, "harmonic") < 1e-13);
        // The condition number is the square of the harmonic one; the stored solution itself is good to 6e-14.
        CHECK(error(bilaplacian(L, voronoi_masses(X, triangles)), *file, "biharmonic") < 1e-12);
    }
}

TEST_CASE("agrees with an independent program on a tet mesh") {
    if (const std::optional<NpzFile> file = reference_case("o6_tet.npz")) {
        const CellMesh<Tet4, double> mesh{file->at("X").columns3<double>(), file->at("T").columns<std::int32_t, 4>()};
        CHECK(error(cotangent_laplacian(mesh), *file, "harmonic") < 1e-13);
    }
}
#endif
