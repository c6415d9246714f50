// SPDX-License-Identifier: MIT
#include <softtissue/skinning/uniform_cubic_spline.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
MatrixX<S> random_values(Index functions, Index knots) {
    RandomGenerator random(4);
    MatrixX<S> values(functions, knots);
    for (Index i = 0; i < values.size(); ++i) {
        values(i) = S(random.normal());
    }
    return values;
}

/// Second derivative within one cubic: a central difference is exact there.
double second_derivative(const UniformCubicSpline<double>& spline, double u, double h) {
    return (spline(u - h)(0) - 2 * spline(u)(0) + spline(u + h)(0)) / (h * h);
}

}  // namespace

TEST_CASE_TEMPLATE("knots are met exactly, for every number of them", S, float, double) {
    for (Index knots = 1; knots <= 9; ++knots) {
        const MatrixX<S> values = random_values<S>(3, knots);
        const UniformCubicSpline<S> spline(values);
        CHECK(spline.num_knots() == knots);
        CHECK(spline.num_functions() == 3);
        for (Index i = 0; i < knots; ++i) {
            CHECK(spline(S(i)) == values.col(i));
        }
    }
}

TEST_CASE_TEMPLATE("polynomials of the stated degree come back, ends included", S, float, double) {
    for (Index knots = 1; knots <= 9; ++knots) {
        const Index degree = std::min(knots - 1, Index(3));
        const auto polynomial = [degree](S u) {
            const S x = u / S(4);
            return S(1) + (degree > 0 ? x : S(0)) - (degree > 1 ? 2 * x * x : S(0)) +
                   (degree > 2 ? x * x * x : S(0));
        };
        MatrixX<S> values(1, knots);
        for (Index i = 0; i < knots; ++i) {
            values(0, i) = polynomial(S(i));
        }
        const UniformCubicSpline<S> spline(values);
        for (S u = S(-0.25); u <= S(knots) - S(0.75); u += S(0.125)) {
            CAPTURE(knots);
            CAPTURE(u);
            // second differences of numbers up to 2, elimination with factors below 2
            CHECK(std::abs(spline(u)(0) - polynomial(u)) <= 50 * std::numeric_limits<S>::epsilon());
        }
    }
}

TEST_CASE("twice continuously differentiable; the third derivative jumps, but not next to the ends") {
    const UniformCubicSpline<double> spline(random_values<double>(1, 10));
    for (Index knot = 1; knot < 9; ++knot) {
        // y''(knot + h) - y''(knot - h) = O(h): it halves with h
        const auto jump = [&](double h) {
            return second_derivative(spline, double(knot) + h, h / 2) -
                   second_derivative(spline, double(knot) - h, h / 2);
        };
        const double coarse = jump(0.02), fine = jump(0.01);
        CHECK(fine == doctest::Approx(coarse / 2).epsilon(1e-6));
        // slopes of y'' on the two sides of the knot
        const auto third = [&](double u) {
            return (second_derivative(spline, u + 0.1, 0.05) - second_derivative(spline, u - 0.1, 0.05)) / 0.2;
        };
        const double kink = std::abs(third(double(knot) + 0.5) - third(double(knot) - 0.5));
        if (knot == 1 || knot == 8) {
            CHECK(kink <= 1e-9);
        } else {
            CHECK(kink >= 1e-2);
        }
    }
}

TEST_CASE("error of a smooth function falls with the fourth power of the step, ends included") {
    const auto error = [](Index knots) {
        MatrixX<double> values(1, knots);
        const double step = 3.0 / double(knots - 1);
        for (Index i = 0; i < knots; ++i) {
            values(0, i) = std::sin(step * double(i));
        }
        const UniformCubicSpline<double> spline(values);
        double worst = 0;
        for (int k = 0; k <= 1000; ++k) {
            const double t = 3.0 * k / 1000;
            worst = std::max(worst, std::abs(spline(t / step)(0) - std::sin(t)));
        }
        return worst;
    };
    CHECK(std::log2(error(41) / error(81)) >= 3.9);
}

TEST_CASE("no knots are refused") {
    CHECK_THROWS_WITH_AS(UniformCubicSpline<double>(MatrixX<double>(3, 0)),
                         "cubic spline: no knots, expected at least one", InvalidInput);
}
