// SPDX-License-Identifier: MIT
#include <softtissue/testing/law_report.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/error.hpp>

#include <limits>

using namespace softtissue;

TEST_CASE("a report without laws has not passed") {
    CHECK_FALSE(LawReport{}.all_passed());
}

TEST_CASE("a law keeps its worst case, whatever the order") {
    LawReport report;
    report.at_most("small", 1, 2, "first");
    CHECK(report.all_passed());
    report.at_most("small", 3, 2, "second");
    report.at_most("small", 0, 2, "third");
    CHECK(report.results.size() == 1);
    CHECK(report["small"].measured == 3);
    CHECK(report["small"].detail == "second");
    CHECK_FALSE(report.all_passed());

    report.at_least("large", 5, 2, "first");
    report.at_least("large", 4, 2, "second");
    report.at_least("large", 6, 2, "third");
    CHECK(report["large"].passed);
    CHECK(report["large"].measured == 4);
    CHECK(report.results.size() == 2);
}

TEST_CASE("the bounds themselves pass") {
    LawReport report;
    report.at_most("most", 2, 2);
    report.at_least("least", 2, 2);
    CHECK(report.all_passed());
}

TEST_CASE("a measure that is not a number fails and stays") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    LawReport report;
    report.at_most("most", 1, 2);
    report.at_most("most", nan, 2, "nan");
    report.at_most("most", 100, 2);
    report.at_least("least", nan, 2, "nan");
    report.at_least("least", -100, 2);
    CHECK(report["most"].detail == "nan");
    CHECK(report["least"].detail == "nan");
    CHECK_FALSE(report["most"].passed);
    CHECK_FALSE(report["least"].passed);
}

TEST_CASE("the summary has a line per law and says where a broken one broke") {
    LawReport report;
    report.at_most("symmetry", 1e-17, 1e-13, "state 4");
    report.at_least("order", 1, 1.9, "state 7");
    CHECK(report.summary() ==
          "ok      symmetry: measured 1e-17, tolerance 1e-13\n"
          "BROKEN  order: measured 1, tolerance 1.9, at state 7\n");
}

TEST_CASE("a law that was not checked cannot be asked for") {
    LawReport report;
    report.at_most("symmetry", 1, 2);
    CHECK(report.has("symmetry"));
    CHECK_FALSE(report.has("symetry"));
    CHECK_THROWS_AS(report["symetry"], InvalidInput);
}
