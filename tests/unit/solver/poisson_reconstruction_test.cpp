// SPDX-License-Identifier: MIT
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <softtissue/core/thread_executor.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
Matrix3X<S> random_shape(const Matrix3X<S>& X, double size, std::uint64_t seed) {
    RandomGenerator random(seed);
    Matrix3X<S> x = X;
    for (Index v = 0; v < X.cols(); ++v) {
        x.col(v) += S(size) * random_normal<Vector3<S>>(random);
    }
    return x;
}

template <class S>
Matrix3X<S> with_free_columns_of(const PrescribedVertices& prescribed, const Matrix3X<S>& boundary,
                                 const Matrix3X<S>& inside) {
    Matrix3X<S> x = boundary;
    for (const std::int32_t v : prescribed.free_vertices()) {
        x.col(v) = inside.col(v);
    }
    return x;
}

}  // namespace

TEST_CASE_TEMPLATE("a shape comes back from its gradients, whatever the start", Block, SolidBlock<Tet4, float>,
                   SolidBlock<Tet4, double>, SolidBlock<Prism6, float>, SolidBlock<Prism6, double>) {
    using E = typename decltype(Block::mesh)::CellElement;
    using S = typename decltype(Block::mesh)::Scalar;
    const auto block = solid_block<E, S>({.n = 3, .plan_noise = 0.1, .level_noise = 0.1});
    const Matrix3X<S>& X = block.mesh.rest_positions;
    PoissonReconstruction<E, S> poisson(block.mesh, PrescribedVertices(X.cols(), block.bottom));
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const Matrix3X<S> shape = random_shape(X, 0.05, seed);
        Matrix3X<S> F;
        poisson.gradients_into(shape, F);
        Matrix3X<S> x = with_free_columns_of(poisson.prescribed(), shape, random_shape(X, 0.5, seed + 50));
        poisson.solve_into(F, x);
        // the condition number of the scalar matrix is below 1e4
        CHECK((x - shape).cwiseAbs().maxCoeff() < S(2e3) * std::numeric_limits<S>::epsilon());
        for (const std::int32_t v : block.bottom) {
            CHECK(x.col(v) == shape.col(v));
        }
    }
}

TEST_CASE_TEMPLATE("targets that no shape has are met in the least-squares sense", E, Tet4, Prism6) {
    const auto block = solid_block<E>({.n = 2, .plan_noise = 0.1});
    const Matrix3X<double>& X = block.mesh.rest_positions;
    PoissonReconstruction<E, double> poisson(block.mesh, PrescribedVertices(X.cols(), block.bottom));
    const Matrix3X<double> targets =
        random_shape(Matrix3X<double>(Matrix3X<double>::Zero(3, 3 * poisson.num_cells())), 1, 9);
    const auto distance = [&](const Matrix3X<double>& x) {
        Matrix3X<double> F;
        poisson.gradients_into(x, F);
        double sum = 0;
        for (Index c = 0; c < poisson.num_cells(); ++c) {
            sum += poisson.rest().volumes(c) * (F - targets).template middleCols<3>(3 * c).squaredNorm();
        }
        return sum;
    };
    Matrix3X<double> x = X;
    poisson.solve_into(targets, x);
    const double least = distance(x);
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
        const Matrix3X<double> moved = with_free_columns_of(poisson.prescribed(), x, random_shape(x, 1e-3, seed));
        CHECK(distance(moved) > least);
    }
    CHECK(least < distance(X));
}

TEST_CASE("the gradients of an affine motion are its matrix") {
    const auto block = solid_block<Prism6>({.n = 3, .plan_noise = 0.1, .level_noise = 0.2, .noise = 0.05});
    const Matrix3X<double>& X = block.mesh.rest_positions;
    const PoissonReconstruction<Prism6, double> poisson(block.mesh, PrescribedVertices(X.cols(), block.bottom));
    RandomGenerator random(2);
    const Matrix3<double> A = random_normal<Matrix3<double>>(random);
    Matrix3X<double> F;
    poisson.gradients_into((A * X).colwise() + random_normal<Vector3<double>>(random), F);
    for (Index c = 0; c < poisson.num_cells(); ++c) {
        CHECK((F.middleCols<3>(3 * c) - A).norm() < 1e-12);
    }
}

TEST_CASE("the same bits for any executor") {
    const auto block = solid_block<Prism6>({.n = 3, .plan_noise = 0.1});
    const Matrix3X<double>& X = block.mesh.rest_positions;
    PoissonReconstruction<Prism6, double> poisson(block.mesh, PrescribedVertices(X.cols(), block.bottom));
    const Matrix3X<double> shape = random_shape(X, 0.05, 4);
    Matrix3X<double> F, F_threads, x = X, y = X;
    poisson.gradients_into(shape, F);
    poisson.solve_into(F, x);
    const ThreadExecutor threads(3);
    poisson.gradients_into(shape, F_threads, threads);
    poisson.solve_into(F_threads, y, threads);
    CHECK(F == F_threads);
    CHECK(x == y);
}

TEST_CASE("what leaves the operator singular is refused") {
    const auto block = solid_block<Prism6>({.n = 1});
    const Index n = block.mesh.num_vertices();
    CHECK_THROWS_AS((PoissonReconstruction<Prism6, double>(block.mesh, PrescribedVertices(n, {}))), InvalidInput);
    CHECK_THROWS_WITH_AS((PoissonReconstruction<Prism6, double>(block.mesh, PrescribedVertices(n + 1, block.bottom))),
                         "Poisson reconstruction: prescribed vertices of 9 vertices, expected 8", InvalidInput);
    PoissonReconstruction<Prism6, double> poisson(block.mesh, PrescribedVertices(n, block.bottom));
    Matrix3X<double> x = block.mesh.rest_positions;
    CHECK_THROWS_WITH_AS(poisson.solve_into(Matrix3X<double>::Zero(3, 3), x),
                         "Poisson reconstruction: 3 columns of target gradients, expected three for each of 2 cells",
                         InvalidInput);
}

TEST_CASE_TEMPLATE("targets and positions that give no finite result are refused by name, and nothing is changed", S,
                   float, double) {
    using Limits = std::numeric_limits<S>;
    const auto block = solid_block<Prism6, S>({.n = 2});
    const Matrix3X<S>& X = block.mesh.rest_positions;
    PoissonReconstruction<Prism6, S> poisson(block.mesh, PrescribedVertices(X.cols(), block.bottom));
    const Matrix3X<S> targets = Matrix3<S>::Identity().replicate(1, poisson.num_cells());
    Matrix3X<S> good = X;
    poisson.solve_into(targets, good);
    for (const S bad : {Limits::quiet_NaN(), Limits::infinity()}) {
        Matrix3X<S> spoilt = targets, x = X;
        spoilt(1, 3 * 5 + 2) = bad;
        CHECK_THROWS_WITH_AS(poisson.solve_into(spoilt, x),
                             "Poisson reconstruction: target gradient of cell 5 is not finite", InvalidInput);
        CHECK(x == X);
        CHECK_FALSE(poisson.solve_finite_into(spoilt, x));
        CHECK(x == X);
        for (const std::int32_t v : {block.bottom[2], poisson.prescribed().free_vertices()[3]}) {
            x = X;
            x(0, v) = bad;
            CHECK_THROWS_AS(poisson.solve_into(targets, x), InvalidInput);
        }
    }
    Matrix3X<S> x = X;
    const Matrix3X<S> huge = Matrix3X<S>::Constant(3, targets.cols(), Limits::max());
    CHECK_THROWS_AS(poisson.solve_into(huge, x), InvalidInput);
    CHECK(x == X);
    poisson.solve_into(targets, x);  // nothing of it is left
    CHECK(x == good);
}
