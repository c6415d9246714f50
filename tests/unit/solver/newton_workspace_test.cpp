// SPDX-License-Identifier: MIT
#include <softtissue/solver/newton_workspace.hpp>

#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/separable_energy.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("a solve in the memory of others is the same as in its own") {
    const SequentialExecutor executor;
    NewtonWorkspace<double> workspace;
    for (const Index n : {4, 4, 2, 7}) {
        SeparableEnergy<double, Spring<double>> term{{}};
        Objective objective(PrescribedVertices(n, {}), executor, term);
        DirectSolver<double> solver;
        const NewtonOptions<double> options{.quasi_newton_steps = 3};
        Matrix3X<double> d = Matrix3X<double>::Constant(3, n, 0.7), alone = d;
        const SolveReport<double> report = minimise(objective, solver, d, options, NoObserver{}, workspace);
        CHECK(report.succeeded());
        CHECK(report.energy == minimise(objective, solver, alone, options).energy);
        CHECK(d == alone);
        CHECK(workspace.gradient.size() == 3 * n);
    }
}
