// SPDX-License-Identifier: MIT
// The embedded human jumps: every step converges.
#include <support/moving_human.hpp>

using namespace softtissue_test;

TEST_CASE("the embedded human in motion, in double", "[motion]") {
    const RunSummary summary = run_human<double>(30);
    check_run(summary);
    CHECK(summary.largest_start_error < 1e-10);
}
