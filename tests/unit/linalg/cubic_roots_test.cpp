// SPDX-License-Identifier: MIT
#include <softtissue/linalg/cubic_roots.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// scale (s - a)(s - b)(s - c)
template <class Real>
Cubic<Real> with_roots(Real scale, Real a, Real b, Real c) {
    return {-scale * a * b * c, scale * (a * b + b * c + c * a), -scale * (a + b + c), scale};
}

}  // namespace

TEST_CASE_TEMPLATE("three simple roots are found in order", Real, float, double) {
    RandomGenerator random(3);
    for (int sample = 0; sample < 1000; ++sample) {
        std::array<Real, 3> expected;
        expected[0] = Real(random.uniform(-3, 0));
        expected[1] = expected[0] + Real(random.uniform(0.5, 2));
        expected[2] = expected[1] + Real(random.uniform(0.5, 2));
        const Real scale = Real(random.uniform(-2, 2));
        const CubicRoots<Real> roots =
            cubic_roots(with_roots(scale, expected[0], expected[1], expected[2]), Real(-9), Real(9));
        REQUIRE(roots.count == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            // Coefficients are rounded: at most 64 scale epsilon, over a slope of at least 0.25 scale.
            CHECK(std::abs(roots.values[i] - expected[i]) < 256 * std::numeric_limits<Real>::epsilon());
        }
    }
}

TEST_CASE_TEMPLATE("lower degrees are cubics with leading zeros", Real, float, double) {
    const CubicRoots<Real> linear = cubic_roots<Real>({-1, 2, 0, 0}, -5, 5);
    REQUIRE(linear.count == 1);
    CHECK(linear.values[0] == Real(0.5));
    const CubicRoots<Real> quadratic = cubic_roots<Real>({-4, 0, 1, 0}, -5, 5);
    REQUIRE(quadratic.count == 2);
    CHECK(quadratic.values[0] == doctest::Approx(-2));
    CHECK(quadratic.values[1] == doctest::Approx(2));
    CHECK(cubic_roots<Real>({1, 0, 0, 0}, -5, 5).count == 0);
    CHECK(cubic_roots<Real>({0, 0, 0, 0}, -5, 5).count == 0);
    // A leading coefficient of round-off size has its other root far outside.
    const CubicRoots<Real> nearly_linear = cubic_roots<Real>({-1, 2, 0, std::numeric_limits<Real>::epsilon()}, -5, 5);
    REQUIRE(nearly_linear.count == 1);
    CHECK(nearly_linear.values[0] == doctest::Approx(0.5));
}

TEST_CASE("only roots of the interval count") {
    const Cubic<double> c = with_roots(1.0, -1.0, 0.5, 2.0);
    CHECK(cubic_roots(c, 0.0, 1.0).count == 1);
    CHECK(cubic_roots(c, 0.6, 1.9).count == 0);
    CHECK(cubic_roots(c, -2.0, 1.0).count == 2);
    CHECK(cubic_roots(c, 3.0, 9.0).count == 0);
}

TEST_CASE("where the cubic touches zero there are no roots or two, never one; a triple root is one") {
    const CubicRoots<double> touching = cubic_roots(with_roots(1.0, 1.0, 1.0, 3.0), -5.0, 5.0);
    CHECK((touching.count == 1 || touching.count == 3));
    CHECK(touching.values[std::size_t(touching.count - 1)] == doctest::Approx(3));
    for (int i = 0; i + 1 < touching.count; ++i) {
        CHECK(touching.values[std::size_t(i)] == doctest::Approx(1).epsilon(1e-6));
    }
    const CubicRoots<double> triple = cubic_roots(with_roots(1.0, 0.0, 0.0, 0.0), -4.0, 5.0);
    REQUIRE(triple.count == 1);
    CHECK(std::abs(triple.values[0]) < 1e-5);  // s^3 is below round-off there
}

TEST_CASE("roots of very different scale keep their relative accuracy") {
    const CubicRoots<double> roots = cubic_roots(with_roots(1.0, 1e-8, 1.0, 30.0), -32.0, 33.0);
    REQUIRE(roots.count == 3);
    CHECK(roots.values[0] == doctest::Approx(1e-8).epsilon(1e-14));
    CHECK(roots.values[2] == doctest::Approx(30).epsilon(1e-13));
}
