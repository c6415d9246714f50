// SPDX-License-Identifier: MIT
#include <softtissue/solver/report.hpp>

#include <doctest/doctest.h>

#include <array>
#include <set>
#include <string>

using namespace softtissue;

TEST_CASE_TEMPLATE("two of the statuses are a success", Scalar, float, double) {
    SolveReport<Scalar> report;
    CHECK_FALSE(report.succeeded());
    const std::array<SolveStatus, 8> all{
        SolveStatus::converged,           SolveStatus::precision_limit,      SolveStatus::iteration_limit,
        SolveStatus::saddle_point,        SolveStatus::line_search_stalled,  SolveStatus::linear_solver_failed,
        SolveStatus::not_finite,          SolveStatus::cancelled};
    std::set<std::string> words;
    for (const SolveStatus status : all) {
        report.status = status;
        CHECK(report.succeeded() == (status == SolveStatus::converged || status == SolveStatus::precision_limit));
        words.insert(to_string(status));
    }
    CHECK(words.size() == all.size());
    CHECK(words.count("unknown") == 0);
}
