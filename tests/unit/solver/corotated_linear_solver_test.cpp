// SPDX-License-Identifier: MIT
#include <softtissue/solver/corotated_linear_solver.hpp>

#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/cell_weights.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/solver/newton.hpp>

#include <support/rigged_bar.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("one solve is the minimum of the energy, from any start", E, Tet4, Prism6) {
    const RiggedBar<E> bar(2);
    const SequentialExecutor executor;
    const std::vector<LameParameters<double>> moduli(size_t(bar.mesh.num_cells()), {6e3, 2e4});
    const PrescribedVertices prescribed(bar.mesh.num_vertices(), bar.prescribed);
    CorotatedLinearSolver<E, double, SequentialExecutor> solver(bar.mesh, prescribed, moduli, executor);
    const VolumetricSmpl<double, LinearBlend<double>> model(bar.body);
    const PosedBody<double> posed = model.pose(RiggedBar<E>::pose(0.7));
    const auto rotations =
        BlendedRotations<double>(cell_weights(model.weights(), bar.mesh.cells)).rotations(posed.joint_transforms);

    Matrix3X<double> x = posed.positions;
    REQUIRE(solver.solve_into(rotations, x));
    Matrix3X<double> from_elsewhere = posed.positions;
    for (const std::int32_t v : prescribed.free_vertices()) {
        from_elsewhere.col(v).setConstant(0.3);
    }
    REQUIRE(solver.solve_into(rotations, from_elsewhere));
    CHECK((x - from_elsewhere).cwiseAbs().maxCoeff() < 1e-12);
    for (const std::int32_t v : bar.prescribed) {
        CHECK(x.col(v) == posed.positions.col(v));
    }

    CorotatedLinearField<double> field(moduli);
    field.set_rotations(rotations);
    ElasticEnergy<E, CorotatedLinearField<double>> elastic(bar.mesh, field);
    Objective objective(prescribed, executor, elastic);
    CHECK(objective.gradient(x - bar.mesh.rest_positions).cwiseAbs().maxCoeff() < 1e-10);
    CHECK(objective.energy(x - bar.mesh.rest_positions) < objective.energy(posed.positions - bar.mesh.rest_positions));
}

TEST_CASE("a rigid motion of all bones is followed exactly") {
    const RiggedBar<Prism6> bar(2);
    const SequentialExecutor executor;
    const std::vector<LameParameters<double>> moduli(size_t(bar.mesh.num_cells()), {6e3, 2e4});
    const VolumetricSmpl<double, LinearBlend<double>> model(bar.body);
    Pose<double> pose = Pose<double>::rest(3);
    pose.rotation_vectors.col(0) << 1, -0.5, 2;
    const PosedBody<double> posed = model.pose(pose);
    const std::vector<Matrix3<double>> rotations(size_t(bar.mesh.num_cells()), posed.joint_transforms[0].linear);
    const PrescribedVertices prescribed(bar.mesh.num_vertices(), bar.prescribed);
    CorotatedLinearSolver<Prism6, double, SequentialExecutor> solver(bar.mesh, prescribed, moduli, executor);
    Matrix3X<double> x = posed.positions;
    for (const std::int32_t v : prescribed.free_vertices()) {
        x.col(v).setZero();
    }
    REQUIRE(solver.solve_into(rotations, x));
    CHECK((x - posed.positions).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a start that is not finite gives no result, and rotations that are not are refused") {
    const RiggedBar<Prism6> bar(2);
    const SequentialExecutor executor;
    const std::vector<LameParameters<double>> moduli(size_t(bar.mesh.num_cells()), {1e4, 2e4});
    CorotatedLinearSolver<Prism6, double, SequentialExecutor> solver(
        bar.mesh, PrescribedVertices(bar.mesh.num_vertices(), bar.prescribed), moduli, executor);
    std::vector<Matrix3<double>> rotations(size_t(bar.mesh.num_cells()), Matrix3<double>::Identity());
    Matrix3X<double> x = bar.mesh.rest_positions;
    x(0, bar.prescribed[1]) = std::numeric_limits<double>::quiet_NaN();
    const Matrix3X<double> start = x;
    CHECK_FALSE(solver.solve_into(rotations, x));
    CHECK((x.array() == start.array() || start.array().isNaN()).all());
    rotations[2](1, 1) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(static_cast<void>(solver.solve_into(rotations, x)),
                         "co-rotated linear: rotation of cell 2 is not finite", InvalidInput);
}
