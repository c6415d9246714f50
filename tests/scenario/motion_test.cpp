// SPDX-License-Identifier: MIT
// The embedded human jumps: every step converges. What strains quasi-Newton steps most, very soft, thick tissue and poses whose velocity
// jumps, ends where Newton's method ends.
#include <support/moving_human.hpp>

using namespace softtissue_test;

namespace {

/// Steps with the default options beside steps by Newton's method to a tenth of a micrometre.
void check_against_newton(HumanRun<double> run, double tolerance) {
    const RunSummary fast = run_human<double>(run);
    check_run(fast);
    run.options.quasi_newton.max_steps = 0;
    run.options.newton.step_tolerance = 1e-7;
    const RunSummary exact = run_human<double>(run);
    CHECK(exact.not_converged == 0);
    CHECK(exact.mean_quasi_newton_steps == 0.0);
    double error = 0;
    for (size_t k = 0; k < exact.positions.size(); ++k) {
        error = std::max(error, (fast.positions[k] - exact.positions[k]).colwise().norm().maxCoeff());
    }
    WARN("at most " << 1e3 * error << " mm from Newton's method");
    CHECK(error < tolerance);
}

}  // namespace

TEST_CASE("the embedded human in motion, in double", "[motion]") {
    const RunSummary summary = run_human<double>({.num_steps = 30});
    check_run(summary);
    CHECK(summary.largest_start_error < 1e-10);
}

TEST_CASE("very soft, thick tissue in motion", "[motion]") {
    check_against_newton(
        {.num_steps = 8, .tissue = {.normal_modulus = 1e3, .tangential_modulus = 5e3}, .full_thickness = 0.05}, 2e-4);
}

TEST_CASE("very soft, thick tissue at sixty steps a second, driven by thirty poses a second", "[motion]") {
    check_against_newton({.num_steps = 8,
                          .options = {.time_step = 1.0 / 60},
                          .tissue = {.normal_modulus = 1e3, .tangential_modulus = 5e3},
                          .full_thickness = 0.05,
                          .key_frame_rate = 30},
                         2e-4);
}
