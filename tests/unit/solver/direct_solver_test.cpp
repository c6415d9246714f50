// SPDX-License-Identifier: MIT
#include <softtissue/solver/direct_solver.hpp>

#include <softtissue/solver/metric_cg.hpp>
#include <softtissue/solver/scalar_metric.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(FactorKeepingSolver<DirectSolver<float>>);
static_assert(!FactorKeepingSolver<MetricCg<ScalarMetric<double>>>);

namespace {

/// A chain 0 - 1 - ... with random symmetric blocks, diagonally dominant by `dominance`.
template <class S>
BlockMatrix<S> chain(const std::vector<std::pair<std::int32_t, std::int32_t>>& links, Index n, S dominance,
                     RandomGenerator& random) {
    std::vector<std::vector<std::int32_t>> neighbours(static_cast<size_t>(n));
    for (const auto& [i, j] : links) {
        neighbours[size_t(i)].push_back(j);
        neighbours[size_t(j)].push_back(i);
    }
    BlockMatrix<S> H{BlockPattern(std::move(neighbours))};
    for (Index j = 0; j < n; ++j) {
        H.add(j, H.pattern().rank(j, std::int32_t(j)), dominance * Matrix3<S>::Identity());
    }
    for (const auto& [i, j] : links) {
        const Matrix3<S> block = random_normal<Matrix3<S>>(random);
        H.add(j, H.pattern().rank(j, i), block);
        H.add(i, H.pattern().rank(i, j), block.transpose());
    }
    return H;
}

}  // namespace

TEST_CASE_TEMPLATE("a positive definite system is solved", Scalar, float, double) {
    RandomGenerator random(1);
    const BlockMatrix<Scalar> H = chain<Scalar>({{0, 1}, {1, 2}, {2, 3}}, 4, Scalar(12), random);
    const VectorX<Scalar> expected = VectorX<Scalar>::NullaryExpr(12, [&] { return Scalar(random.normal()); });
    VectorX<Scalar> p;
    DirectSolver<Scalar> solver;
    const LinearSolveResult result = solver.solve(H, H.matrix() * expected, Scalar(0), p, SequentialExecutor{});
    CHECK(result.is_positive_definite);
    CHECK(result.iterations == 0);
    CHECK((p - expected).norm() < 64 * std::numeric_limits<Scalar>::epsilon() * expected.norm());
    // the factor stays reachable
    const VectorX<Scalar> again = solver.factor().solve(H.matrix() * expected);
    CHECK(again == p);
    VectorX<Scalar> twice;
    solver.solve_again(H.matrix() * (Scalar(2) * expected), twice);
    CHECK((twice - Scalar(2) * p).norm() < 64 * std::numeric_limits<Scalar>::epsilon() * expected.norm());
}

TEST_CASE_TEMPLATE("an indefinite matrix is reported, and does not spoil the next one", Scalar, float, double) {
    RandomGenerator random(2);
    const BlockMatrix<Scalar> indefinite = chain<Scalar>({{0, 1}}, 2, Scalar(0.1), random);
    const BlockMatrix<Scalar> definite = chain<Scalar>({{0, 1}}, 2, Scalar(12), random);
    DirectSolver<Scalar> solver;
    VectorX<Scalar> p;
    const VectorX<Scalar> rhs = VectorX<Scalar>::Ones(6);
    CHECK_FALSE(solver.factorize(indefinite));
    CHECK_FALSE(solver.solve(indefinite, rhs, Scalar(0), p, SequentialExecutor{}).is_positive_definite);
    CHECK(solver.solve(definite, rhs, Scalar(0), p, SequentialExecutor{}).is_positive_definite);
    CHECK((definite.matrix() * p - rhs).norm() < 64 * std::numeric_limits<Scalar>::epsilon());
}

TEST_CASE("a matrix of another pattern with as many blocks is analysed anew") {
    RandomGenerator random(3);
    DirectSolver<double> solver;
    VectorX<double> p;
    const VectorX<double> rhs = VectorX<double>::Ones(12);
    for (const auto& H :
         {chain<double>({{0, 1}, {1, 2}}, 4, 12, random), chain<double>({{0, 3}, {1, 3}}, 4, 12, random)}) {
        REQUIRE(solver.solve(H, rhs, 0, p, SequentialExecutor{}).is_positive_definite);
        CHECK((H.matrix() * p - rhs).norm() < 1e-13);
    }
}
