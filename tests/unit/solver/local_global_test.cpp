// SPDX-License-Identifier: MIT
#include <softtissue/solver/local_global.hpp>

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// A block whose bottom is held and whose top is turned and lifted.
template <class E>
struct TwistedBlock {
    SolidBlock<E, double> block = solid_block<E>({.n = 2, .plan_noise = 0.1});
    std::vector<std::int32_t> held = block.bottom;
    Matrix3X<double> start = block.mesh.rest_positions;

    TwistedBlock() {
        held.insert(held.end(), block.top.begin(), block.top.end());
        const double angle = 0.5;
        for (const std::int32_t v : block.top) {
            const Vector3<double> p = start.col(v) - Vector3<double>(0.5, 0.5, 0);
            start.col(v) << 0.5 + std::cos(angle) * p(0) - std::sin(angle) * p(1),
                0.5 + std::sin(angle) * p(0) + std::cos(angle) * p(1), p(2) + 0.1;
        }
    }
    PrescribedVertices prescribed() const { return {block.mesh.num_vertices(), held}; }
};

}  // namespace

TEST_CASE_TEMPLATE("finds the ARAP shape that Newton finds, never going up", E, Tet4, Prism6) {
    const TwistedBlock<E> twisted;
    PoissonReconstruction<E, double> poisson(twisted.block.mesh, twisted.prescribed());
    LocalGlobal<E, double> solver(poisson);

    const SequentialExecutor executor;
    // psi = |F - R|^2
    ElasticEnergy<E, UniformField<Arap<double>>> arap(twisted.block.mesh, UniformField{Arap<double>({.stiffness = 1})});
    Objective objective(twisted.prescribed(), executor, arap);
    const Matrix3X<double>& X = twisted.block.mesh.rest_positions;

    Matrix3X<double> x = twisted.start;
    double last = objective.energy(x - X);
    const double start = last;
    for (int k = 0; k < 20; ++k) {
        const LocalGlobalReport<double> one = solver.solve_into(x, {.max_iterations = 1, .step_tolerance = 0});
        CHECK(one.status == SolveStatus::iteration_limit);
        const double energy = objective.energy(x - X);
        CHECK(energy <= last * (1 + 1e-14));
        last = energy;
    }
    CHECK(last < 0.9 * start);
    const LocalGlobalReport<double> report = solver.solve_into(x, {.max_iterations = 5000, .step_tolerance = 1e-13});
    CHECK(report.status == SolveStatus::converged);
    CHECK(report.step <= 1e-13);

    Matrix3X<double> d = twisted.start - X;
    DirectSolver<double> linear_solver;
    CHECK(minimise(objective, linear_solver, d).succeeded());
    CHECK((x - X - d).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a start that is not finite is reported and left alone") {
    const TwistedBlock<Tet4> twisted;
    PoissonReconstruction<Tet4, double> poisson(twisted.block.mesh, twisted.prescribed());
    LocalGlobal<Tet4, double> solver(poisson);
    Matrix3X<double> x = twisted.start;
    x(0, 0) = std::numeric_limits<double>::quiet_NaN();
    const LocalGlobalReport<double> report = solver.solve_into(x);
    CHECK(report.status == SolveStatus::not_finite);
    CHECK(report.iterations == 0);
    CHECK(x.rightCols(x.cols() - 1) == twisted.start.rightCols(x.cols() - 1));
}
