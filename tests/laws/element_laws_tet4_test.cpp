// SPDX-License-Identifier: MIT
// The element laws for Tet4, in float and double.
#include <softtissue/testing/element_laws.hpp>

#include <softtissue/element/tet4.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("Tet4 obeys the element laws", Scalar, float, double) {
    NodePositions<Tet4, Scalar> X;
    X << 0, 1, 0, 0,  //
        0, 0, 1, 0,   //
        0, 0, 0, 1;
    const LawReport report = check_element_laws<Tet4, Scalar>(X, {.samples = 200});
    INFO(report.summary());
    CHECK(report.all_passed());
    CHECK(report.has("symmetries"));
    CHECK(report.has("faces outward"));
}
