// SPDX-License-Identifier: MIT
// The anisotropic exponential law: the patch test; a boundary that moves far at once.
#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/catch.hpp>
#include <support/patch_test.hpp>
#include <support/solid_block.hpp>

#include <cstdint>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("patch test of skin", "[element]") {
    RandomGenerator random(9);
    const UniformField field{
        FungOrthotropic<double>({.normal_modulus = 1e4, .tangential_modulus = 5e4}, random_rotation<double>(random))};
    for (const PatchResult& result : {patch_test<Tet4>({.n = 3, .noise = 0.12}, field),
                                      patch_test<Prism6>({.n = 3, .plan_noise = 0.1, .level_noise = 0.2}, field)}) {
        CHECK(result.succeeded);
        CHECK(result.num_inner == 8);
        CHECK(result.error < 1e-12);
    }
}

TEST_CASE("skin whose boundary was turned, stretched or crushed at once finds its equilibrium", "[solver]") {
    const UniformField field{FungOrthotropic<double>({.normal_modulus = 1e4, .tangential_modulus = 5e4},
                                                     Matrix3<double>(Matrix3<double>::Identity()))};
    const auto block = solid_block<Tet4>({.n = 2, .noise = 0.05});
    const Matrix3X<double>& X = block.mesh.rest_positions;
    std::vector<std::int32_t> held = block.bottom;
    held.insert(held.end(), block.top.begin(), block.top.end());
    ElasticEnergy<Tet4, UniformField<FungOrthotropic<double>>> elastic(block.mesh, field);
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(X.cols(), held), executor, elastic);
    DirectSolver<double> linear_solver;
    for (const Vector3<double>& scale :
         {Vector3<double>(-1, -1, 1), Vector3<double>(3, 3, 1), Vector3<double>(0.01, 1, -1)}) {
        CAPTURE(scale.transpose());
        Matrix3X<double> start = Matrix3X<double>::Zero(3, X.cols());
        for (const std::int32_t v : block.top) {
            start.col(v) = (scale - Vector3<double>::Ones()).cwiseProduct(X.col(v) - Vector3<double>(0.5, 0.5, 0));
        }
        Matrix3X<double> d = start, slow = start;
        const SolveReport<double> report = minimise(objective, linear_solver, d);
        CHECK(report.succeeded());
        CHECK(report.iterations <= 45);
        // it lowers the exponent by one in each iteration
        const SolveReport<double> plain =
            minimise(objective, linear_solver, slow, {.max_iterations = 60, .max_doublings = 0});
        CHECK(plain.status == SolveStatus::iteration_limit);
        CHECK(plain.energy >= report.energy);
    }
}
