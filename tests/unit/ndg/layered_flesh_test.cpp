// SPDX-License-Identifier: MIT
#include <softtissue/ndg/layered_flesh.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/solver/direct_solver.hpp>

#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("rest is an equilibrium, and stays one under a rigid motion", S, float, double) {
    const LayeredLimb<S> limb;
    const SequentialExecutor executor;
    LayeredFlesh<S, SequentialExecutor> flesh(limb.body, {}, executor);
    const Matrix3X<S>& X = limb.body.mesh.rest_positions;
    Matrix3X<S> x = X;
    const S at_rest = flesh.energy(x);
    CHECK(flesh.solve_into(x).succeeded());
    CHECK((x - X).cwiseAbs().maxCoeff() < S(1e3) * std::numeric_limits<S>::epsilon());

    const Matrix3<S> R = rotation_matrix_from_rotation_vector<S>(Vector3<S>(S(0.3), S(-1), S(0.5)));
    x = R * X;
    CHECK(flesh.energy(x) == doctest::Approx(double(at_rest)).epsilon(1e-4));
    for (const std::int32_t v : flesh.prescribed().free_vertices()) {
        x.col(v) += Vector3<S>(S(0.004), S(-0.002), S(0.003));
    }
    const SolveReport<S> report = flesh.solve_into(x);
    CHECK(report.status == SolveStatus::converged);
    CHECK((x - R * X).colwise().norm().maxCoeff() < S(1e-4));
}

TEST_CASE("bent, the energy falls from any start to the same equilibrium; a tighter tolerance moves little") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredFlesh<double, SequentialExecutor> flesh(limb.body, {}, executor);
    const Matrix3X<double> bent = limb.bent(0.7);
    std::vector<double> energies;
    const auto watch = [&](const NewtonProgress<double>& progress) {
        energies.push_back(progress.energy);
        return true;
    };
    Matrix3X<double> x = bent;
    const SolveReport<double> report = flesh.solve_into(x, quasi_static_options<double>(), watch);
    REQUIRE(report.status == SolveStatus::converged);
    CHECK(report.energy == doctest::Approx(flesh.energy(x)).epsilon(1e-12));
    for (size_t k = 1; k < energies.size(); ++k) {
        CHECK(energies[k] <= energies[k - 1]);
    }
    for (const std::int32_t v : limb.body.prescribed) {
        CHECK(x.col(v) == bent.col(v));
    }
    Matrix3X<double> other = bent;
    for (const std::int32_t v : flesh.prescribed().free_vertices()) {
        other.col(v) = limb.body.mesh.rest_positions.col(v);  // far away, inverted prisms
    }
    REQUIRE(flesh.solve_into(other).status == SolveStatus::converged);
    CHECK((other - x).colwise().norm().mean() < 1e-5);

    NewtonOptions<double> tight = quasi_static_options<double>();
    tight.decrement_tolerance /= 10;
    Matrix3X<double> tighter = bent;
    REQUIRE(flesh.solve_into(tighter, tight).status == SolveStatus::converged);
    CHECK((tighter - x).colwise().norm().mean() < 1e-5);
}

TEST_CASE("conjugate gradients and a factorisation find the same equilibrium, on any number of threads") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredFlesh<double, SequentialExecutor> flesh(limb.body, {}, executor);
    LayeredFlesh<double, SequentialExecutor, DirectSolver<double>> factored(limb.body, {}, executor);
    for (const double angle : {0.2, 0.7, 1.2}) {
        CAPTURE(angle);
        Matrix3X<double> x = limb.bent(angle), y = x, z = x;
        const SolveReport<double> fast = flesh.solve_into(x), plain = factored.solve_into(y);
        REQUIRE(fast.status == SolveStatus::converged);
        REQUIRE(plain.status == SolveStatus::converged);
        CHECK(fast.linear_iterations > 0);
        CHECK(fast.decrement <= 1e-4);
        CHECK(fast.iterations <= plain.iterations + 2);
        CHECK(std::abs(fast.energy - plain.energy) < 1e-4);
        CHECK((x - y).colwise().norm().mean() < 2e-5);
        const ThreadExecutor threads(3);
        LayeredFlesh<double, ThreadExecutor> threaded(limb.body, {}, threads);
        CHECK(threaded.solve_into(z).iterations == fast.iterations);
        CHECK(z == x);
    }
}

TEST_CASE("what cannot be solved is reported, sizes are checked") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredFlesh<double, SequentialExecutor> flesh(limb.body, {}, executor);
    Matrix3X<double> x = limb.bent(0.7);
    NewtonOptions<double> options = quasi_static_options<double>();
    options.max_iterations = 1;
    CHECK(flesh.solve_into(x, options).status == SolveStatus::iteration_limit);
    x(0, 5) = std::numeric_limits<double>::quiet_NaN();
    CHECK(flesh.solve_into(x).status == SolveStatus::not_finite);
    x.conservativeResize(3, 7);
    CHECK_THROWS_WITH_AS((void)flesh.solve_into(x), doctest::Contains("layered flesh: 7 positions, expected "),
                         InvalidInput);
}
