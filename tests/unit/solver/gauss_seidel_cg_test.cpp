// SPDX-License-Identifier: MIT
#include <softtissue/solver/gauss_seidel_cg.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/solver/direct_solver.hpp>

#include <support/spring_lattice.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <utility>

using namespace softtissue;
using namespace softtissue_test;

static_assert(FactorKeepingSolver<GaussSeidelCg<float>>);
static_assert(FactorKeepingSolver<GaussSeidelCg<double>>);
static_assert(FactorKeepingSolver<GaussSeidelCg<double, double>>);

TEST_CASE_TEMPLATE("the step and what it promises are as accurate as asked for", Solver, GaussSeidelCg<float>,
                   GaussSeidelCg<double>, GaussSeidelCg<double, double>) {
    using Scalar = typename Solver::Scalar;
    RandomGenerator random(1);
    const BlockMatrix<Scalar> H = spring_lattice<Scalar>(15, 12, 0.05, random);
    const VectorX<Scalar> rhs = random_vector<Scalar>(H.matrix().rows(), random);
    VectorX<Scalar> exact, p;
    DirectSolver<Scalar> direct;
    REQUIRE(direct.solve(H, rhs, Scalar(0), exact, SequentialExecutor{}).is_positive_definite);
    Solver solver;
    int last = 0;
    for (const Scalar tolerance : {Scalar(0.1), Scalar(1e-2), Scalar(1e-3), Scalar(1e-5), Scalar(1e-8)}) {
        if (tolerance < Scalar(100) * std::numeric_limits<Scalar>::epsilon()) {
            continue;
        }
        CAPTURE(tolerance);
        const LinearSolveResult result = solver.solve(H, rhs, tolerance, p, SequentialExecutor{});
        CHECK(result.is_positive_definite);
        CHECK(result.iterations > last);
        last = result.iterations;
        CHECK((p - exact).norm() <= Scalar(10) * tolerance * exact.norm());
        const Scalar missing = (p - exact).dot(H.matrix() * (p - exact)) / exact.dot(rhs);
        CHECK(missing <= Scalar(10) * tolerance * tolerance + Scalar(10) * std::numeric_limits<Scalar>::epsilon());
        // the same bits on threads, and again
        VectorX<Scalar> other;
        CHECK(Solver().solve(H, rhs, tolerance, other, ThreadExecutor(3)).iterations == result.iterations);
        CHECK(other == p);
        CHECK(solver.solve(H, rhs, tolerance, other, SequentialExecutor{}).iterations == result.iterations);
        CHECK(other == p);
    }
    CHECK(last < 100);
}

TEST_CASE_TEMPLATE("another right-hand side of the last matrix; sizes of any order of magnitude", Solver,
                   GaussSeidelCg<float>, GaussSeidelCg<double>) {
    using Scalar = typename Solver::Scalar;
    RandomGenerator random(2);
    const BlockMatrix<Scalar> H = spring_lattice<Scalar>(8, 9, 0.1, random);
    const VectorX<Scalar> b = random_vector<Scalar>(H.matrix().rows(), random),
                          c = random_vector<Scalar>(b.size(), random);
    Solver solver;
    VectorX<Scalar> p, again, zero;
    (void)solver.solve(H, b, Scalar(1e-2), p, SequentialExecutor{});
    solver.solve_again(c, again);
    (void)solver.solve(H, c, Scalar(1e-2), p, SequentialExecutor{});
    CHECK(again == p);
    for (const Scalar size : {Scalar(1e-15), Scalar(1e15)}) {
        (void)solver.solve(H, (size * c).eval(), Scalar(1e-2), again, SequentialExecutor{});
        CHECK((again - size * p).norm() < Scalar(1e-4) * again.norm());
    }
    solver.solve_again(VectorX<Scalar>::Zero(c.size()), zero);
    CHECK(zero == VectorX<Scalar>::Zero(c.size()));
    CHECK(solver.solve(H, VectorX<Scalar>::Zero(c.size()), Scalar(1e-2), zero, SequentialExecutor{}).iterations == 0);
    CHECK(zero == VectorX<Scalar>::Zero(c.size()));
}

TEST_CASE_TEMPLATE("negative curvature and numbers that are none are reported", Scalar, float, double) {
    RandomGenerator random(4);
    GaussSeidelCg<Scalar> solver;
    VectorX<Scalar> p;
    const VectorX<Scalar> rhs = random_vector<Scalar>(3 * 60, random);
    // vertices that are alone show it in their own block, others in the iteration
    const BlockMatrix<Scalar> anchored_to_nothing = spring_lattice<Scalar>(6, 10, -0.1, random);
    CHECK_FALSE(solver.solve(anchored_to_nothing, rhs, Scalar(1e-2), p, SequentialExecutor{}).is_positive_definite);
    BlockMatrix<Scalar> indefinite = spring_lattice<Scalar>(6, 10, 1, random);
    for (const auto& [j, i] : {std::pair{0, 1}, std::pair{1, 0}}) {
        indefinite.add(j, indefinite.pattern().rank(j, i), Scalar(40) * Matrix3<Scalar>::Identity());
    }
    const LinearSolveResult result = solver.solve(indefinite, rhs, Scalar(1e-2), p, SequentialExecutor{});
    CHECK_FALSE(result.is_positive_definite);
    CHECK(result.iterations > 0);
    const BlockMatrix<Scalar> H = spring_lattice<Scalar>(6, 10, 1, random);
    VectorX<Scalar> bad = rhs;
    bad(7) = std::numeric_limits<Scalar>::quiet_NaN();
    CHECK_FALSE(solver.solve(H, bad, Scalar(1e-2), p, SequentialExecutor{}).is_positive_definite);
    CHECK(solver.solve(H, rhs, Scalar(1e-2), p, SequentialExecutor{}).is_positive_definite);
}
