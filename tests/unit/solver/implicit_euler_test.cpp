// SPDX-License-Identifier: MIT
#include <softtissue/solver/implicit_euler.hpp>

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/solver/direct_solver.hpp>

#include <support/separable_energy.hpp>
#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;
using namespace softtissue_test;

namespace {
const SequentialExecutor executor;
using Springs = SeparableEnergy<double, Spring<double>>;
}  // namespace

TEST_CASE_TEMPLATE("free fall is that of implicit Euler exactly", Scalar, float, double) {
    const Matrix3X<Scalar> start = Matrix3X<Scalar>::Constant(3, 2, Scalar(1));
    const Scalar dt = Scalar(0.01);
    const Vector3<Scalar> gravity(0, Scalar(-9.81), 0);
    DirectSolver<Scalar> linear_solver;
    SeparableEnergy<Scalar, Spring<Scalar>> nothing{{.stiffness = 0}};
    ImplicitEuler euler(VectorX<Scalar>(Vector3<Scalar>(1, 5, 0).template head<2>()), dt, PrescribedVertices(2, {}),
                        start, linear_solver, executor, nothing);
    CHECK(euler.time_step() == dt);
    euler.set_acceleration(gravity);
    euler.placement().origins = start;
    Matrix3X<Scalar> d = Matrix3X<Scalar>::Zero(3, 2);
    const int num_steps = 20;
    for (int step = 0; step < num_steps; ++step) {
        CHECK(euler.step(d).succeeded());
    }
    // v_n = n dt g, x_n = x_0 + n (n + 1) / 2 dt^2 g: round-off of positions, divided by dt for velocities
    const Scalar tolerance = 16 * num_steps * std::numeric_limits<Scalar>::epsilon();
    const Vector3<Scalar> fallen = Scalar(num_steps * (num_steps + 1) / 2) * dt * dt * gravity;
    for (Index v = 0; v < 2; ++v) {
        CHECK((euler.state().positions.col(v) - start.col(v) - fallen).norm() < tolerance);
        CHECK((euler.state().velocities.col(v) - Scalar(num_steps) * dt * gravity).norm() < tolerance / dt);
    }
}

TEST_CASE("a free body keeps its momentum, and loses energy only") {
    const auto block = solid_block<Tet4>({.n = 2, .noise = 0.05});
    ElasticEnergy<Tet4, UniformField<Arap<double>>> elastic(block.mesh, UniformField{Arap<double>({.stiffness = 1e4})});
    const VectorX<double> masses = lumped_masses(block.mesh, 1000.0);
    DirectSolver<double> linear_solver;
    const Index n = block.mesh.num_vertices();
    ImplicitEuler euler(masses, 1.0 / 120.0, PrescribedVertices(n, {}), block.mesh.rest_positions, linear_solver,
                        executor, elastic);
    euler.placement().origins = block.mesh.rest_positions;
    RandomGenerator random(3);
    DynamicState<double> state = euler.state();
    state.velocities = random_displacement<double>(n, 1.0, random);
    euler.set_state(state);
    const Vector3<double> momentum = state.velocities * masses;
    const auto energy = [&] {
        const Matrix3X<double> d = euler.state().positions - block.mesh.rest_positions;
        return elastic.energy(d, executor) +
               0.5 * euler.state().velocities.colwise().squaredNorm().dot(masses.transpose());
    };
    double last = energy();
    Matrix3X<double> d = Matrix3X<double>::Zero(3, n);
    for (int step = 0; step < 10; ++step) {
        CHECK(euler.step(d).succeeded());
        CHECK((euler.state().velocities * masses - momentum).norm() < 1e-8 * masses.sum());
        CHECK(energy() < last);
        last = energy();
    }
}

TEST_CASE("an oscillation converges with the first power of the time step") {
    // x'' = -w^2 x from x = 1 at rest, at t = 0.2
    const double stiffness = 40, mass = 2, w = std::sqrt(stiffness / mass), end = 0.2;
    const auto error = [&](int num_steps) {
        Springs springs{{.stiffness = stiffness}};
        DirectSolver<double> linear_solver;
        const Matrix3X<double> origin = Matrix3X<double>::Zero(3, 1), start = Matrix3X<double>::Ones(3, 1);
        ImplicitEuler euler(VectorX<double>::Constant(1, mass), end / num_steps, PrescribedVertices(1, {}), start,
                            linear_solver, executor, springs);
        euler.placement().origins = origin;
        Matrix3X<double> d = start;
        for (int step = 0; step < num_steps; ++step) {
            CHECK(euler.step(d).succeeded());
        }
        return std::abs(d(0, 0) - std::cos(w * end));
    };
    const double coarse = error(40), middle = error(80), fine = error(160);
    MESSAGE("orders in the time step: ", std::log2(coarse / middle), ", ", std::log2(middle / fine));
    CHECK(std::log2(coarse / middle) == doctest::Approx(1.0).epsilon(0.05));
    CHECK(std::log2(middle / fine) == doctest::Approx(1.0).epsilon(0.03));
}

TEST_CASE("prescribed vertices go where they are told and pull the others") {
    const auto block = solid_block<Tet4>({.n = 2});
    ElasticEnergy<Tet4, UniformField<Arap<double>>> elastic(block.mesh, UniformField{Arap<double>({.stiffness = 1e6})});
    VectorX<double> masses = lumped_masses(block.mesh, 1000.0);
    for (const std::int32_t v : block.bottom) {
        masses(v) = 0;  // a prescribed vertex needs no mass
    }
    DirectSolver<double> linear_solver;
    const Index n = block.mesh.num_vertices();
    ImplicitEuler euler(masses, 0.01, PrescribedVertices(n, block.bottom), block.mesh.rest_positions, linear_solver,
                        executor, elastic);
    euler.placement().origins = block.mesh.rest_positions;
    Matrix3X<double> d = Matrix3X<double>::Zero(3, n);
    const Vector3<double> shift(0.03, 0.01, 0);
    for (const std::int32_t v : block.bottom) {
        d.col(v) = shift;
    }
    for (int step = 0; step < 200; ++step) {
        CHECK(euler.step(d).succeeded());
        if (step == 0) {
            CHECK((d.col(block.bottom[0]) - shift).norm() == 0.0);
            CHECK((euler.state().velocities.col(block.bottom[0]) - shift / 0.01).norm() < 1e-13);
            CHECK(d.col(block.top[0]).norm() < 0.5 * shift.norm());
        }
    }
    // numerical damping has stopped it where the boundary is
    CHECK((d.colwise() - shift).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("of several starts the one with the lowest energy is taken; the placement maps d") {
    Springs springs{{.stiffness = 1}};
    DirectSolver<double> linear_solver;
    const Matrix3X<double> origin = Matrix3X<double>::Zero(3, 1);
    ImplicitEuler euler(VectorX<double>::Constant(1, 1.0), 0.1, PrescribedVertices(1, {}), origin, linear_solver,
                        executor, springs);
    euler.placement().origins = Matrix3X<double>::Constant(3, 1, 1.0);
    euler.placement().maps = 2 * Matrix3<double>::Identity();
    Matrix3X<double> d = Matrix3X<double>::Constant(3, 1, 100.0);
    const Matrix3X<double> better = Matrix3X<double>::Constant(3, 1, -0.4);
    // x = 1 + 2 d; minimum of d^2/2 + 50 (1 + 2 d)^2 at d = -200/401
    const SolveReport<double> report = euler.step(d, {.max_iterations = 0}, {&better});
    CHECK(report.status == SolveStatus::iteration_limit);
    CHECK(d == better);
    euler.set_state({origin, origin});
    CHECK(euler.step(d).succeeded());
    CHECK(d(0, 0) == doctest::Approx(-200.0 / 401.0).epsilon(1e-14));
    CHECK(euler.state().positions(0, 0) == doctest::Approx(1 - 400.0 / 401.0).epsilon(1e-12));
}

TEST_CASE("an observer may cancel a step") {
    Springs springs{{.stiffness = 1}};
    DirectSolver<double> linear_solver;
    const Matrix3X<double> start = Matrix3X<double>::Ones(3, 1);
    ImplicitEuler euler(VectorX<double>::Constant(1, 1.0), 0.1, PrescribedVertices(1, {}), start, linear_solver,
                        executor, springs);
    euler.placement().origins = start;
    Matrix3X<double> d = Matrix3X<double>::Constant(3, 1, 0.5);
    const auto cancel = [](const NewtonProgress<double>&) { return false; };
    CHECK(euler.step(d, {}, {}, cancel).status == SolveStatus::cancelled);
}

TEST_CASE("a time step or masses that make no sense are refused") {
    Springs springs{};
    DirectSolver<double> linear_solver;
    const Matrix3X<double> start = Matrix3X<double>::Zero(3, 2);
    const auto make = [&](const VectorX<double>& masses, double dt) {
        const ImplicitEuler euler(masses, dt, PrescribedVertices(2, {}), start, linear_solver, executor, springs);
        return euler.time_step();
    };
    CHECK(make(Eigen::Vector2d(1, 2), 0.1) == 0.1);
    CHECK_THROWS_WITH_AS(make(Eigen::Vector2d(1, 2), -0.1), "time step = -0.1 s, expected > 0", InvalidInput);
    CHECK_THROWS_WITH_AS(make(Eigen::Vector2d(1, 0), 0.1), "mass of free vertex 1 = 0 kg, expected > 0", InvalidInput);
    CHECK_THROWS_WITH_AS(make(Eigen::Vector3d(1, 2, 3), 0.1),
                         "implicit Euler: 3 masses, expected one for each of 2 vertices", InvalidInput);
    CHECK_THROWS_AS(make(Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 1), 0.1), InvalidInput);
}

TEST_CASE("a state or an acceleration that is not finite is refused") {
    Springs springs{};
    DirectSolver<double> linear_solver;
    const Matrix3X<double> start = Matrix3X<double>::Zero(3, 2);
    ImplicitEuler euler(Eigen::Vector2d(1, 2).eval(), 0.1, PrescribedVertices(2, {}), start, linear_solver, executor,
                        springs);
    DynamicState<double> state = euler.state();
    state.positions(1, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(euler.set_state(state), "implicit Euler: position of vertex 1 is not finite", InvalidInput);
    state = euler.state();
    state.velocities(2, 0) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(euler.set_state(state), "implicit Euler: velocity of vertex 0 is not finite", InvalidInput);
    state.velocities.resize(3, 3);
    CHECK_THROWS_WITH_AS(euler.set_state(state),
                         "implicit Euler: 3 columns of velocity, expected one for each of 2 vertices", InvalidInput);
    CHECK(euler.state().velocities.isZero(0.0));
    CHECK_THROWS_WITH_AS(euler.set_acceleration(Vector3<double>(0, std::nan(""), 0)),
                         "implicit Euler: the acceleration is not finite", InvalidInput);
}
