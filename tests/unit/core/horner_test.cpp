// SPDX-License-Identifier: MIT
#include <softtissue/core/horner.hpp>

#include <softtissue/core/dual.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("the highest power comes first", S, float, double) {
    static_assert(horner(S(2), 3.0) == S(3));
    static_assert(horner(S(2), 3.0, 4.0, 5.0) == S(25));
    static_assert(horner(S(-2), 3.0, 4.0, 5.0) == S(9));
}

TEST_CASE("numbers that carry derivatives") {
    const auto x = Dual<double, 1>::variable(2, 0);
    const Dual<double, 1> y = horner(x, 3.0, 4.0, 5.0);
    CHECK(y.value == 25);
    CHECK(y.derivative[0] == 16);
}
