// SPDX-License-Identifier: MIT
#include <softtissue/solver/continuation.hpp>

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Fung = FungOrthotropic<double>;

/// A block of skin between two grips, the upper of which turns around z and rises.
struct Grips {
    SolidBlock<Tet4, double> block = solid_block<Tet4>({.n = 3, .noise = 0.05});
    SequentialExecutor executor;
    ElasticEnergy<Tet4, UniformField<Fung>> elastic{
        block.mesh, UniformField{Fung({.normal_modulus = 1e4, .tangential_modulus = 4e4}, Matrix3<double>::Identity())}};
    Objective<SequentialExecutor, ElasticEnergy<Tet4, UniformField<Fung>>> objective{held(), executor, elastic};
    DirectSolver<double> linear_solver;
    Matrix3X<double> d = Matrix3X<double>::Zero(3, block.mesh.num_vertices());

    PrescribedVertices held() const {
        std::vector<std::int32_t> both = block.bottom;
        both.insert(both.end(), block.top.begin(), block.top.end());
        return {block.mesh.num_vertices(), both};
    }

    Matrix3X<double> target(double angle, double rise) const {
        Matrix3X<double> result = Matrix3X<double>::Zero(3, block.mesh.num_vertices());
        for (const std::int32_t v : block.top) {
            const Vector3<double> X = block.mesh.rest_positions.col(v);
            const double c = std::cos(angle), s = std::sin(angle), x = X(0) - 0.5, y = X(1) - 0.5;
            result.col(v) << c * x - s * y - x, s * x + c * y - y, rise;
        }
        return result;
    }

    double largest_gradient() { return objective.gradient(d).cwiseAbs().maxCoeff(); }
};

}  // namespace

TEST_CASE("a small motion takes one increment") {
    Grips grips;
    const Matrix3X<double> target = grips.target(0.1, 0.02);
    const SolveReport<double> report = follow_boundary(grips.objective, grips.linear_solver, grips.d, target);
    CHECK(report.succeeded());
    CHECK(report.iterations <= 6);
    CHECK(grips.largest_gradient() < 1e-7);
    for (const std::int32_t v : grips.block.top) {
        CHECK(grips.d.col(v) == target.col(v));
    }
    for (const std::int32_t v : grips.block.bottom) {
        CHECK(grips.d.col(v).norm() == 0.0);
    }
}

TEST_CASE("a motion too large for Newton alone is split") {
    const double angle = 2.6, rise = 0.8;
    Grips alone;
    Matrix3X<double> jumped = alone.target(angle, rise);
    const ContinuationOptions<double> options;
    NewtonOptions<double> newton = options.newton;
    newton.max_iterations = options.iterations_per_increment;
    const SolveReport<double> jump = minimise(alone.objective, alone.linear_solver, jumped, newton);
    MESSAGE("Newton from the jump: ", std::string(to_string(jump.status)), " after ", jump.iterations, ", energy ", jump.energy);
    CHECK_FALSE(jump.succeeded());

    Grips grips;
    int increments = 0;
    const Matrix3X<double> target = grips.target(angle, rise);
    const SolveReport<double> report =
        follow_boundary(grips.objective, grips.linear_solver, grips.d, target, options,
                        [&](const NewtonProgress<double>& progress) {
                            increments += progress.iteration == 0 ? 1 : 0;
                            return true;
                        });
    MESSAGE("followed in ", increments, " increments, ", report.iterations, " iterations, energy ", report.energy);
    CHECK(report.succeeded());
    CHECK(increments > 1);
    // beside the forces at the grips
    CHECK(grips.largest_gradient() < 1e-11 * grips.objective.full_gradient(grips.d).cwiseAbs().maxCoeff());
    double worst = 0;
    for (const std::int32_t v : grips.block.top) {
        worst = std::max(worst, (grips.d.col(v) - target.col(v)).norm());
    }
    CHECK(worst < 1e-15);
}

TEST_CASE("cancelling leaves the last equilibrium") {
    Grips grips;
    const SolveReport<double> at_once =
        follow_boundary(grips.objective, grips.linear_solver, grips.d, grips.target(0.5, 0.1), {},
                        [](const NewtonProgress<double>&) { return false; });
    CHECK(at_once.status == SolveStatus::cancelled);
    CHECK(grips.d.norm() == 0.0);
}

TEST_CASE("a motion that no increment can follow ends with the reason") {
    Grips grips;
    const SolveReport<double> report =
        follow_boundary(grips.objective, grips.linear_solver, grips.d, grips.target(0.0, 0.1),
                        {.newton = {.max_iterations = 0}, .iterations_per_increment = 0, .max_halvings = 3});
    CHECK(report.status == SolveStatus::iteration_limit);
    CHECK(grips.d.norm() == 0.0);
}

TEST_CASE("standing still is a motion too") {
    Grips grips;
    const SolveReport<double> report = follow_boundary(grips.objective, grips.linear_solver, grips.d, grips.d);
    CHECK(report.succeeded());
    CHECK(report.iterations <= 1);
}
