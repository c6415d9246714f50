// SPDX-License-Identifier: MIT
// The element laws for Prism6, in float and double.
#include <softtissue/testing/element_laws.hpp>

#include <softtissue/element/prism6.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("Prism6 obeys the element laws", Scalar, float, double) {
    NodePositions<Prism6, Scalar> X;
    X << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,   //
        0, 0, 0, 1, 1, 1;

    SUBCASE("well-shaped, sheared and twisted cells") {
        const LawReport report = check_element_laws<Prism6, Scalar>(X, {.samples = 200});
        INFO(report.summary());
        CHECK(report.all_passed());
        CHECK(report.has("symmetries"));
        CHECK(report.has("faces outward"));
    }
    SUBCASE("cells a hundred times thinner than wide") {
        X.row(2) /= 100;
        const LawReport report =
            check_element_laws<Prism6, Scalar>(X, {.samples = 200, .noise = 0.002, .thinnest = 0.5});
        INFO(report.summary());
        CHECK(report.all_passed());
    }
}
