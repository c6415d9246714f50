// SPDX-License-Identifier: MIT
#include <softtissue/solver/concepts.hpp>

#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/metric_cg.hpp>
#include <softtissue/solver/scalar_metric.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// A user's solver: one step of Jacobi, enough for diagonal systems.
struct DiagonalSolver {
    using Scalar = double;
    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<double>& H, const VectorX<double>& rhs, double, VectorX<double>& p,
                            const E&) {
        const VectorX<double> diagonal = H.matrix().diagonal();
        p = rhs.cwiseQuotient(diagonal);
        return {.is_positive_definite = diagonal.minCoeff() > 0, .iterations = 1};
    }
};
struct ReturnsNothing {
    using Scalar = double;
    template <Executor E>
    void solve(const BlockMatrix<double>&, const VectorX<double>&, double, VectorX<double>&, const E&) {}
};
struct NoScalar {
    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<double>&, const VectorX<double>&, double, VectorX<double>&, const E&);
};

}  // namespace

static_assert(NewtonLinearSolver<DirectSolver<double>>);
static_assert(NewtonLinearSolver<DirectSolver<float>>);
static_assert(NewtonLinearSolver<MetricCg<ScalarMetric<double>>>);
static_assert(NewtonLinearSolver<MetricCg<ScalarMetric<float>>>);
static_assert(NewtonLinearSolver<DiagonalSolver>);
static_assert(!NewtonLinearSolver<ReturnsNothing>);
static_assert(!NewtonLinearSolver<NoScalar>);

TEST_CASE("a user's linear solver follows the same protocol") {
    BlockMatrix<double> H{BlockPattern(std::vector<std::vector<std::int32_t>>(1))};
    H.add(0, 0, 4 * Matrix3<double>::Identity());
    VectorX<double> p;
    DiagonalSolver solver;
    const LinearSolveResult result = solver.solve(H, Vector3<double>(4, 8, 12), 1e-3, p, SequentialExecutor{});
    CHECK(result.is_positive_definite);
    CHECK(p == Vector3<double>(1, 2, 3));
}
