// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#if __has_include(<cholmod.h>)
#include <softtissue/sparse/cholmod.hpp>

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/solid_block.hpp>

using namespace softtissue;
using namespace softtissue_test;

static_assert(SparseCholesky<CholmodCholesky, double>);

TEST_CASE("CHOLMOD reaches the same equilibrium as Eigen's Cholesky") {
    const auto block = solid_block<Tet4>({.n = 3, .noise = 0.08});
    const UniformField field{StableNeoHookean<double>::from_young_poisson({1e4, 0.4})};
    ElasticEnergy<Tet4, UniformField<StableNeoHookean<double>>> elastic(block.mesh, field);
    const SequentialExecutor executor;
    std::vector<std::int32_t> held = block.bottom;
    held.insert(held.end(), block.top.begin(), block.top.end());
    Objective objective(PrescribedVertices(block.mesh.num_vertices(), held), executor, elastic);
    Matrix3X<double> start = Matrix3X<double>::Zero(3, block.mesh.num_vertices());
    for (const std::int32_t v : block.top) {
        start.col(v) << 0.1, 0.2, -0.2;
    }
    Matrix3X<double> d = start, d_cholmod = start;
    DirectSolver<double> eigen;
    DirectSolver<double, CholmodCholesky> cholmod;
    CHECK(minimise(objective, eigen, d).succeeded());
    CHECK(minimise(objective, cholmod, d_cholmod).succeeded());
    // both errors are the square of a Newton step below 1e-9
    CHECK((d - d_cholmod).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("CHOLMOD tells an indefinite matrix and recovers") {
    BlockMatrix<double> H(BlockPattern({{1}, {0}}));
    H.add(0, 0, Matrix3<double>::Identity());
    H.add(1, 1, Matrix3<double>(Vector3<double>(1, -1, 1).asDiagonal()));
    DirectSolver<double, CholmodCholesky> solver;
    VectorX<double> p;
    const VectorX<double> rhs = VectorX<double>::Ones(6);
    CHECK_FALSE(solver.solve(H, rhs, 0.0, p, SequentialExecutor{}).is_positive_definite);
    H.add(1, 1, Matrix3<double>(Vector3<double>(0, 2, 0).asDiagonal()));
    REQUIRE(solver.solve(H, rhs, 0.0, p, SequentialExecutor{}).is_positive_definite);
    CHECK((p - rhs).cwiseAbs().maxCoeff() < 1e-15);
}
#else
TEST_CASE("CHOLMOD") { MESSAGE("skipped: cholmod.h is not there"); }
#endif
