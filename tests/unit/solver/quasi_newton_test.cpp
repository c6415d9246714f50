// SPDX-License-Identifier: MIT
#include <softtissue/solver/quasi_newton.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/inertia.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/solver/scalar_metric.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// A block of a metre that stands on its lowest level, a step of implicit Euler after a push of its top by `push` [m].
template <class S>
struct PushedBlock {
    using Material = StableNeoHookean<S>;
    SolidBlock<Prism6, S> block = solid_block<Prism6, S>({.n = 3, .noise = 0.05});
    ElasticEnergy<Prism6, UniformField<Material>> elastic{
        block.mesh, UniformField<Material>{Material::from_textbook_lame({S(2.5e4), S(0.25)})}};
    Inertia<S> inertia;
    Placement<S> placement{block.mesh.rest_positions, {}};
    Matrix3X<S> target = block.mesh.rest_positions;

    explicit PushedBlock(double push) : inertia(masses(), S(0.02)) {
        for (const std::int32_t v : block.top) {
            target(0, v) += S(push);
        }
        inertia.set_step(placement, target);
    }

    VectorX<S> masses() const { return lumped_masses(block.mesh, S(1000)); }
    template <Executor E>
    auto objective(const E& executor) {
        return Objective(PrescribedVertices(block.mesh.num_vertices(), block.bottom), executor, inertia, elastic);
    }
    Matrix3X<S> rest() const { return Matrix3X<S>::Zero(3, block.mesh.num_vertices()); }
};

const SequentialExecutor sequential;

template <class S, class ObjectiveType>
ScalarMetric<S> metric_at_rest(ObjectiveType& objective, const Matrix3X<S>& rest) {
    ScalarMetric<S> metric;
    metric.factorize(objective.hessian(rest, PsdFilter::none), "rest");
    return metric;
}

}  // namespace

TEST_CASE_TEMPLATE("the minimum is Newton's, for small and for large loads", S, float, double) {
    for (const double push : {0.0, 1e-3, 0.3}) {
        CAPTURE(push);
        PushedBlock<S> scene(push);
        auto objective = scene.objective(sequential);
        ScalarMetric<S> metric = metric_at_rest<S>(objective, scene.rest());
        QuasiNewton<S> quasi_newton;
        Matrix3X<S> d = scene.rest();
        const S tolerance = std::is_same_v<S, float> ? S(1e-5) : S(1e-7);
        const SolveReport<S> report =
            quasi_newton.minimise(objective, metric, d, {.tolerance = tolerance, .max_steps = 60});
        CHECK(report.status == SolveStatus::converged);
        CHECK(report.iterations == 0);
        CHECK(report.quasi_newton_steps <= (push == 0.0 ? 1 : 40));
        Matrix3X<S> expected = scene.rest();
        DirectSolver<S> direct;
        REQUIRE(minimise(objective, direct, expected, {.step_tolerance = tolerance / S(10)}).succeeded());
        CHECK((d - expected).cwiseAbs().maxCoeff() <= S(2) * tolerance);
        // again, from another start: what was remembered does not matter
        Matrix3X<S> again = scene.rest();
        CHECK(quasi_newton.minimise(objective, metric, again, {.tolerance = tolerance, .max_steps = 60}).energy ==
              report.energy);
        CHECK(again == d);
    }
}

TEST_CASE("the same bits for any number of threads") {
    std::vector<Matrix3X<double>> results;
    const auto run = [&](const auto& executor) {
        PushedBlock<double> scene(0.2);
        auto objective = scene.objective(executor);
        ScalarMetric<double> metric = metric_at_rest<double>(objective, scene.rest());
        Matrix3X<double> d = scene.rest();
        CHECK(QuasiNewton<double>().minimise(objective, metric, d).succeeded());
        results.push_back(d);
    };
    run(sequential);
    run(ThreadExecutor(2));
    run(ThreadExecutor(3));
    CHECK(results[0] == results[1]);
    CHECK(results[0] == results[2]);
}

TEST_CASE("a metric that does not fit ends with slow convergence, never with more energy") {
    PushedBlock<double> scene(0.3);
    auto objective = scene.objective(sequential);
    BlockMatrix<double> wrong(objective.hessian(scene.rest(), PsdFilter::none).pattern());
    for (Index j = 0; j < wrong.pattern().num_columns(); ++j) {
        const double stiffness = j % 7 == 0 ? 1e5 : 10;
        wrong.add(j, wrong.pattern().rank(j, std::int32_t(j)), stiffness * Matrix3<double>::Identity());
    }
    ScalarMetric<double> metric;
    metric.factorize(wrong, "wrong");
    Matrix3X<double> d = scene.rest();
    const double before = objective.energy(d);
    const SolveReport<double> report = QuasiNewton<double>().minimise(objective, metric, d, {.tolerance = 1e-9});
    CHECK(report.status == SolveStatus::slow_convergence);
    CHECK(report.energy < before);
    CHECK(objective.energy(d) == doctest::Approx(report.energy).epsilon(1e-12));
    DirectSolver<double> direct;
    CHECK(minimise(objective, direct, d).succeeded());  // Newton's method goes on from there
}

TEST_CASE("limits, cancelling and what is not finite are told") {
    PushedBlock<double> scene(0.3);
    auto objective = scene.objective(sequential);
    ScalarMetric<double> metric = metric_at_rest<double>(objective, scene.rest());
    QuasiNewton<double> quasi_newton;
    Matrix3X<double> d = scene.rest();
    CHECK(quasi_newton.minimise(objective, metric, d, {.tolerance = 1e-9, .max_steps = 2}).status ==
          SolveStatus::iteration_limit);
    CHECK(d != scene.rest());
    int calls = 0;
    const auto stop_at_second = [&](const NewtonProgress<double>&) { return ++calls < 2; };
    d = scene.rest();
    const SolveReport<double> report = quasi_newton.minimise(objective, metric, d, {}, stop_at_second);
    CHECK(report.status == SolveStatus::cancelled);
    CHECK(report.quasi_newton_steps == 1);
    d(0, d.cols() - 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK(quasi_newton.minimise(objective, metric, d).status == SolveStatus::not_finite);
}
