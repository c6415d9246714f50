// SPDX-License-Identifier: MIT
// The embedded human jumps in single precision.
#include <support/moving_human.hpp>

using namespace softtissue_test;

TEST_CASE("the embedded human in motion, in float", "[motion]") {
    const RunSummary summary = run_human<float>({.num_steps = 30});
    check_run(summary);
    CHECK(summary.largest_start_error < 1e-4);
}
