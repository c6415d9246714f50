// SPDX-License-Identifier: MIT
/// @file
/// The result of a law suite: what was measured against which tolerance; independent of any test framework.
///
///     const LawReport report = check_material_laws(material);
///     CHECK_MESSAGE(report.all_passed(), report.summary());      // doctest
///     EXPECT_TRUE(report.all_passed()) << report.summary();      // googletest
///
/// What        LawResult per law; a law measured many times keeps its worst case
/// Valid       NaN measures fail every law; a report without laws has not passed
/// Tests       tests/unit/testing/law_report_test.cpp
#pragma once

#include <softtissue/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softtissue {

/// The worst case of one law.
struct LawResult {
    std::string law;
    bool passed;
    double measured;
    double tolerance;
    std::string detail;  ///< where the worst case was met
};

/// The laws that were checked, in the order of their first measurement.
struct LawReport {
    std::vector<LawResult> results;

    /// Measures a law that holds where measured <= tolerance.
    void at_most(std::string_view law, double measured, double tolerance, std::string detail = {}) {
        const auto is_worse = [](double a, double b) { return a > b || std::isnan(a); };
        keep_worst({std::string(law), measured <= tolerance, measured, tolerance, std::move(detail)}, is_worse);
    }

    /// Measures a law that holds where measured >= tolerance.
    void at_least(std::string_view law, double measured, double tolerance, std::string detail = {}) {
        const auto is_worse = [](double a, double b) { return a < b || std::isnan(a); };
        keep_worst({std::string(law), measured >= tolerance, measured, tolerance, std::move(detail)}, is_worse);
    }

    bool all_passed() const {
        return !results.empty() &&
               std::all_of(results.begin(), results.end(), [](const LawResult& r) { return r.passed; });
    }

    /// True where the law was checked.
    bool has(std::string_view law) const { return find(law) != results.end(); }

    /// The result of a law; refuses a law that was not checked.
    const LawResult& operator[](std::string_view law) const {
        require(has(law), "law \"", law, "\" is not in the report, expected one of:\n", summary());
        return *find(law);
    }

    /// One line a law: verdict, name, measure, tolerance, and for a broken law where.
    std::string summary() const {
        std::ostringstream text;
        text.precision(3);
        for (const LawResult& r : results) {
            text << (r.passed ? "ok      " : "BROKEN  ") << r.law << ": measured " << r.measured << ", tolerance "
                 << r.tolerance;
            if (!r.passed && !r.detail.empty()) {
                text << ", at " << r.detail;
            }
            text << '\n';
        }
        return text.str();
    }

private:
    std::vector<LawResult>::const_iterator find(std::string_view law) const {
        return std::find_if(results.begin(), results.end(), [law](const LawResult& r) { return r.law == law; });
    }

    template <class IsWorse>
    void keep_worst(LawResult candidate, const IsWorse& is_worse) {
        const auto known = results.begin() + (find(candidate.law) - results.cbegin());
        if (known == results.end()) {
            results.push_back(std::move(candidate));
        } else if (is_worse(candidate.measured, known->measured)) {
            *known = std::move(candidate);
        }
    }
};

}  // namespace softtissue
