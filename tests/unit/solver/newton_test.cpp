// SPDX-License-Identifier: MIT
#include <softtissue/solver/newton.hpp>

#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/separable_energy.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// exp(x) - 2 x: convex, minimum at log 2.
template <class S>
struct Exponential {
    S value(S x) const { return std::exp(x) - S(2) * x; }
    S first(S x) const { return std::exp(x) - S(2); }
    S second(S x) const { return std::exp(x); }
};

/// x^4/4 - x^2/2: minima at -1 and 1, a maximum at 0 between them.
template <class S>
struct DoubleWell {
    S value(S x) const { return x * x * (x * x / S(4) - S(0.5)); }
    S first(S x) const { return x * (x * x - S(1)); }
    S second(S x) const { return S(3) * x * x - S(1); }
};

/// log(1 + x^2): Newton's full step overshoots from |x| > 1/2 on; the Hessian is indefinite beyond 1.
template <class S>
struct LongTailed {
    S value(S x) const { return std::log(S(1) + x * x); }
    S first(S x) const { return S(2) * x / (S(1) + x * x); }
    S second(S x) const { return S(2) * (S(1) - x * x) / ((S(1) + x * x) * (S(1) + x * x)); }
};

/// exp(x^2): each Newton step lowers the exponent by one.
template <class S>
struct Gaussian {
    S value(S x) const { return std::exp(x * x); }
    S first(S x) const { return S(2) * x * std::exp(x * x); }
    S second(S x) const { return (S(2) + S(4) * x * x) * std::exp(x * x); }
};

/// A gradient of the wrong sign.
struct WrongGradient : Spring<double> {
    double first(double x) const { return -x; }
};

/// A Hessian that no filter makes positive.
struct NotANumber : Spring<double> {
    double second(double) const { return std::numeric_limits<double>::quiet_NaN(); }
};

/// A spring whose energy is rounded so coarsely that it seems to rise with every step.
struct CoarseSpring : Spring<double> {
    double start = 0;
    double value(double x) const { return 1 + Spring<double>::value(x) + (x == start ? 0.0 : 1e-12); }
};

/// Minimises the sum of `f` over two vertices, the first of them held, from `start`.
template <class S, class Function>
struct Solve {
    SequentialExecutor executor;
    SeparableEnergy<S, Function> term;
    std::array<std::int32_t, 1> held{0};
    Objective<SequentialExecutor, SeparableEnergy<S, Function>> objective{PrescribedVertices(2, held), executor, term};
    DirectSolver<S> linear_solver;
    Matrix3X<S> d;
    std::vector<S> energies, residuals;
    SolveReport<S> report;

    Solve(Function f, S start, const NewtonOptions<S>& options = {}, int cancel_at = -1)
        : term{f}, d(Matrix3X<S>::Constant(3, 2, start)) {
        report = minimise(objective, linear_solver, d, options, [&](const NewtonProgress<S>& progress) {
            energies.push_back(progress.energy);
            residuals.push_back(progress.residual);
            CHECK(progress.iteration + 1 == int(energies.size()));
            return progress.iteration != cancel_at;
        });
    }
};

template <class S>
void check_monotone(const std::vector<S>& energies, S final_energy) {
    for (size_t k = 1; k < energies.size(); ++k) {
        CHECK(energies[k] <= energies[k - 1]);
    }
    CHECK(final_energy <= energies.back());
}

}  // namespace

TEST_CASE("convergence is quadratic, the prescribed column stays") {
    Solve<double, Exponential<double>> solve({}, 2.0);
    CHECK(solve.report.status == SolveStatus::converged);
    CHECK(solve.report.filtered_iterations == 0);
    CHECK(solve.d.col(0) == Vector3<double>::Constant(2.0));
    CHECK((solve.d.col(1) - Vector3<double>::Constant(std::log(2.0))).norm() < 1e-15);
    // r_next = r^2 / (2 f''^2 ...) -> r^2 / 4 with f'' = f''' = 2
    int checked = 0;
    for (size_t k = 0; k + 1 < solve.residuals.size(); ++k) {
        if (solve.residuals[k] < 0.1 && solve.residuals[k + 1] > 1e-14) {
            CHECK(solve.residuals[k + 1] == doctest::Approx(solve.residuals[k] * solve.residuals[k] / 4).epsilon(0.1));
            ++checked;
        }
    }
    CHECK(checked >= 2);
    check_monotone(solve.energies, solve.report.energy);
}

TEST_CASE_TEMPLATE("far from a minimum the filtered step descends; the energy never increases", Scalar, float, double) {
    const NewtonOptions<Scalar> options{.step_tolerance = Scalar(1e-5)};
    for (const Scalar start : {Scalar(0.3), Scalar(-0.1), Scalar(1.5), Scalar(9)}) {
        CAPTURE(start);
        Solve<Scalar, DoubleWell<Scalar>> well({}, start, options);
        CHECK(well.report.status == SolveStatus::converged);
        CHECK(std::abs(std::abs(well.d(0, 1)) - Scalar(1)) < Scalar(1e-5));
        check_monotone(well.energies, well.report.energy);
        CHECK((well.report.filtered_iterations > 0) == (std::abs(start) < Scalar(0.577)));

        Solve<Scalar, LongTailed<Scalar>> tail({}, start, options);
        CHECK(tail.report.succeeded());
        CHECK(std::abs(tail.d(0, 1)) < Scalar(1e-5));
        check_monotone(tail.energies, tail.report.energy);
    }
}

TEST_CASE_TEMPLATE("exponentials are left in few steps, however large", Scalar, float, double) {
    const Scalar exponent = sizeof(Scalar) == 4 ? Scalar(64) : Scalar(400);
    const SequentialExecutor executor;
    SeparableEnergy<Scalar, Gaussian<Scalar>> term{};
    Objective objective(PrescribedVertices(1, {}), executor, term);
    DirectSolver<Scalar> linear_solver;
    NewtonOptions<Scalar> options{.max_iterations = 500, .step_tolerance = Scalar(1e-5), .max_doublings = 0};
    const Matrix3X<Scalar> start{{std::sqrt(exponent)}, {std::sqrt(exponent / 2)}, {-std::sqrt(exponent / 3)}};
    Matrix3X<Scalar> d = start;
    CHECK(minimise(objective, linear_solver, d, options).iterations > int(exponent) - 20);

    options.max_doublings = NewtonOptions<Scalar>{}.max_doublings;
    d = start;
    std::vector<Scalar> energies;
    const SolveReport<Scalar> report =
        minimise(objective, linear_solver, d, options, [&](const NewtonProgress<Scalar>& progress) {
            energies.push_back(progress.energy);
            // energy and gradient of the point that was accepted, not of the last one that was tried
            CHECK(objective.energy(d) == progress.energy);
            CHECK(objective.gradient(d).cwiseAbs().maxCoeff() == progress.residual);
            return true;
        });
    CHECK(report.succeeded());
    CHECK(report.iterations <= 25);
    CHECK(report.energy_evaluations <= 100);
    CHECK(d.cwiseAbs().maxCoeff() < Scalar(1e-5));
    check_monotone(energies, report.energy);
}

TEST_CASE("each filter finds the minimum; without one an indefinite Hessian ends the solve") {
    for (const PsdFilter filter : {PsdFilter::absolute, PsdFilter::none}) {
        Solve<double, DoubleWell<double>> solve({}, 0.3, {.filter = filter});
        CHECK(solve.report.status ==
              (filter == PsdFilter::absolute ? SolveStatus::converged : SolveStatus::linear_solver_failed));
    }
}

TEST_CASE("a saddle is told from a minimum") {
    Solve<double, DoubleWell<double>> solve({}, 1e-12);
    CHECK(solve.report.status == SolveStatus::saddle_point);
    CHECK_FALSE(solve.report.succeeded());
}

TEST_CASE("the iteration limit leaves the best point") {
    Solve<double, LongTailed<double>> solve({}, 9.0, {.max_iterations = 3});
    CHECK(solve.report.status == SolveStatus::iteration_limit);
    CHECK(solve.report.iterations == 3);
    CHECK(solve.objective.energy(solve.d) == solve.report.energy);
    CHECK(solve.report.energy < solve.energies.front());
    CHECK(solve.objective.gradient(solve.d).cwiseAbs().maxCoeff() == solve.report.residual);
}

TEST_CASE("an observer may cancel, at once or later") {
    Solve<double, LongTailed<double>> at_once({}, 0.4, {}, 0);
    CHECK(at_once.report.status == SolveStatus::cancelled);
    CHECK(at_once.report.iterations == 0);
    CHECK(at_once.d == Matrix3X<double>::Constant(3, 2, 0.4));
    Solve<double, LongTailed<double>> later({}, 0.4, {}, 2);
    CHECK(later.report.status == SolveStatus::cancelled);
    CHECK(later.report.iterations == 2);
    CHECK(later.report.energy < later.energies.front());
}

TEST_CASE("a start that is not finite is reported and left alone") {
    Solve<double, Exponential<double>> overflow({}, 1e3);
    CHECK(overflow.report.status == SolveStatus::not_finite);
    CHECK(overflow.report.iterations == 0);
    CHECK(overflow.d == Matrix3X<double>::Constant(3, 2, 1e3));
    Solve<double, Spring<double>> nan({}, std::numeric_limits<double>::quiet_NaN());
    CHECK(nan.report.status == SolveStatus::not_finite);
}

TEST_CASE("derivatives that lie end in a status, not in a wrong answer") {
    Solve<double, WrongGradient> wrong(WrongGradient{}, 1.0);
    CHECK(wrong.report.status == SolveStatus::line_search_stalled);
    CHECK(wrong.d(0, 1) == 1.0);
    Solve<double, NotANumber> hessian(NotANumber{}, 1.0);
    CHECK(hessian.report.status == SolveStatus::linear_solver_failed);
    CHECK(hessian.d(0, 1) == 1.0);
}

TEST_CASE("a last step that is lost in the rounding of the energy ends the solve well, a longer one does not") {
    CoarseSpring coarse;
    coarse.start = 5e-10;
    Solve<double, CoarseSpring> near(coarse, coarse.start, {.step_tolerance = 1e-9});
    CHECK(near.report.status == SolveStatus::precision_limit);
    CHECK(near.d(0, 1) == coarse.start);
    coarse.start = 5e-8;
    Solve<double, CoarseSpring> far(coarse, coarse.start, {.step_tolerance = 1e-9});
    CHECK(far.report.status == SolveStatus::line_search_stalled);
}

TEST_CASE("the gradient tolerance stops, at the start if it is met there") {
    Solve<double, Spring<double>> met({.stiffness = 1, .centre = 1e-4}, 0.0, {.gradient_tolerance = 1e-3});
    CHECK(met.report.status == SolveStatus::converged);
    CHECK(met.report.iterations == 0);
    Solve<double, Exponential<double>> reached({}, 2.0, {.step_tolerance = 0, .gradient_tolerance = 1e-3});
    CHECK(reached.report.status == SolveStatus::converged);
    CHECK(reached.report.residual <= 1e-3);
    CHECK(reached.report.residual > 1e-9);
}

TEST_CASE("the decrement stops an exact step, and is what the step gains") {
    Solve<double, Exponential<double>> solve({}, 2.0, {.step_tolerance = 0, .decrement_tolerance = 1e-6});
    CHECK(solve.report.status == SolveStatus::converged);
    CHECK(solve.report.decrement <= 1e-6);
    CHECK(solve.report.decrement > 1e-18);
    CHECK(solve.energies.back() - solve.report.energy == doctest::Approx(solve.report.decrement).epsilon(1e-3));
    Solve<double, DoubleWell<double>> saddle({}, 1e-6, {.step_tolerance = 0, .decrement_tolerance = 1e-6});
    CHECK(saddle.report.status == SolveStatus::converged);
    CHECK(std::abs(std::abs(saddle.d(0, 1)) - 1) < 1e-3);  // a small filtered decrement is no reason to stop
}

TEST_CASE("far steps are filtered without a trial, near ones are exact") {
    Solve<double, DoubleWell<double>> tried({}, 0.3);
    CHECK(tried.report.indefinite_hessians > 0);
    CHECK(tried.report.indefinite_hessians == tried.report.filtered_iterations);
    Solve<double, DoubleWell<double>> spared({}, 0.3, {.far_step = 0.05});
    CHECK(spared.report.status == SolveStatus::converged);
    CHECK(spared.report.indefinite_hessians == 0);
    CHECK(spared.report.filtered_iterations >= 2);
    CHECK(spared.report.iterations > spared.report.filtered_iterations);
    CHECK(spared.d(0, 1) == doctest::Approx(1).epsilon(1e-12));
    // after a failure as many more iterations are filtered
    Solve<double, DoubleWell<double>> patient({}, 0.3, {.filtered_after_failure = 1});
    CHECK(patient.report.indefinite_hessians > 0);
    CHECK(patient.report.filtered_iterations > patient.report.indefinite_hessians);
    CHECK(patient.report.status == SolveStatus::converged);
}

TEST_CASE("steps between the iterations save Hessians and never raise the energy") {
    const Solve<double, LongTailed<double>> plain({}, 0.4);
    const Solve<double, LongTailed<double>> solve({}, 0.4, {.quasi_newton_steps = 5});
    CHECK(plain.report.quasi_newton_steps == 0);
    CHECK(solve.report.status == SolveStatus::converged);
    CHECK(solve.report.quasi_newton_steps > 0);
    CHECK(solve.report.iterations < plain.report.iterations);
    CHECK(std::abs(solve.d(0, 1)) < 1e-9);
    check_monotone(solve.energies, solve.report.energy);
    // it is still an exact step that ends the solve
    const Solve<double, Exponential<double>> decrement(
        {}, 2.0, {.step_tolerance = 0, .decrement_tolerance = 1e-6, .quasi_newton_steps = 5});
    CHECK(decrement.report.status == SolveStatus::converged);
    CHECK(decrement.report.decrement <= 1e-6);
    CHECK(decrement.energies.back() - decrement.report.energy ==
          doctest::Approx(decrement.report.decrement).epsilon(0.01));
}

TEST_CASE("the adaptive filter clamps where the model predicts well") {
    // where f'' < 0 clamping leaves no curvature at all: only the absolute filter can step
    Solve<double, DoubleWell<double>> badly_predicted({}, 0.3, {.adapts_filter = true});
    CHECK(badly_predicted.report.status == SolveStatus::converged);
    // the filtered steps of a quadratic are predicted exactly
    Solve<double, Spring<double>> well_predicted({.stiffness = 1, .centre = 5}, 0.0,
                                                 {.adapts_filter = true, .far_step = 1e-3});
    CHECK(well_predicted.report.status == SolveStatus::converged);
    CHECK(well_predicted.d(0, 1) == doctest::Approx(5));
}

TEST_CASE_TEMPLATE("without a tolerance the precision decides", Scalar, float, double) {
    Solve<Scalar, Exponential<Scalar>> solve({}, Scalar(2), {.step_tolerance = Scalar(0)});
    CHECK(solve.report.succeeded());
    CHECK(std::abs(solve.d(0, 1) - std::log(Scalar(2))) < 4 * std::numeric_limits<Scalar>::epsilon());
    // a stiff spring in a sum with a large constant: no decrease of the energy can be seen
    struct Offset : Exponential<Scalar> {
        Scalar value(Scalar x) const { return Exponential<Scalar>::value(x) + Scalar(1e3); }
    };
    Solve<Scalar, Offset> offset(Offset{}, Scalar(2), {.step_tolerance = Scalar(0)});
    CHECK(offset.report.succeeded());
    CHECK(std::abs(offset.d(0, 1) - std::log(Scalar(2))) < 4 * std::numeric_limits<Scalar>::epsilon());
}

TEST_CASE("nothing free: nothing to do") {
    const SequentialExecutor executor;
    SeparableEnergy<double, Spring<double>> term{};
    const std::array<std::int32_t, 1> held{0};
    Objective objective(PrescribedVertices(1, held), executor, term);
    DirectSolver<double> linear_solver;
    Matrix3X<double> d = Matrix3X<double>::Ones(3, 1);
    const SolveReport<double> report = minimise(objective, linear_solver, d);
    CHECK(report.status == SolveStatus::converged);
    CHECK(report.iterations == 0);
    CHECK(report.energy == 1.5);
}
