// SPDX-License-Identifier: MIT
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <softtissue/testing/random_states.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// The smallest relative error of a slope that must be noticed; see "Blind to" in the header.
template <class S>
constexpr S visible_error = S(0);
template <>
constexpr float visible_error<float> = 2e-2F;
template <>
constexpr double visible_error<double> = 1e-5;

}  // namespace

TEST_CASE_TEMPLATE("a right slope leaves a remainder of order 2, a wrong one of order 1", S, float, double) {
    const auto f = [](S h) { return std::exp(h); };
    const TaylorRate right = taylor_rate(f, S(1));
    CHECK(right.order == doctest::Approx(2).epsilon(0.02));
    CHECK(right.is_at_least(2));
    CHECK_FALSE(right.is_at_least(3));
    CHECK_FALSE(right.is_exact);
    for (const S sign : {S(-1), S(1)}) {
        CHECK_FALSE(taylor_rate(f, S(1) + sign * visible_error<S>).is_at_least(2));
        CHECK(taylor_rate(f, S(1) + sign * S(0.5)).order == doctest::Approx(1).epsilon(0.02));
    }
}

TEST_CASE("a relative error of 1e-4 is caught in double") {
    const auto f = [](double h) { return 3 * std::exp(h) + std::sin(2 * h); };
    CHECK(taylor_rate(f, 5.0).is_at_least(2));
    CHECK_FALSE(taylor_rate(f, 5.0 * (1 + 1e-4)).is_at_least(2));
    CHECK_FALSE(taylor_rate(f, 5.0 * (1 - 1e-4)).is_at_least(2));
}

TEST_CASE_TEMPLATE("the unit of f does not matter", S, float, double) {
    for (const S unit : {S(1e-12), S(1), S(1e9)}) {
        const auto f = [unit](S h) { return unit * std::exp(h); };
        CHECK(taylor_rate(f, unit).is_at_least(2));
        CHECK_FALSE(taylor_rate(f, unit * (1 + visible_error<S>)).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("vectors and matrices are measured as a whole", S, float, double) {
    using Vector = Eigen::Matrix<S, 2, 1>;
    const auto f = [](S h) { return Vector(std::exp(h), std::sin(h)); };
    CHECK(taylor_rate(f, Vector(1, 1)).is_at_least(2));
    CHECK_FALSE(taylor_rate(f, Vector(1, 1 + 2 * visible_error<S>)).is_at_least(2));
}

TEST_CASE_TEMPLATE("a straight line is exact, and its wrong slope is not", S, float, double) {
    const auto f = [](S h) { return S(0.7) + S(1.3) * h; };
    const TaylorRate right = taylor_rate(f, S(1.3));
    CHECK(right.is_exact);
    CHECK(right.is_at_least(2));
    CHECK_FALSE(taylor_rate(f, S(1.3) * (1 + visible_error<S>)).is_at_least(2));
    CHECK(taylor_rate([](S) { return S(0); }, S(0)).is_exact);
}

TEST_CASE_TEMPLATE("a higher order shows as such", S, float, double) {
    const auto cubic = [](S h) { return h * h * h; };
    CHECK(taylor_rate(cubic, S(0)).order == doctest::Approx(3).epsilon(0.02));
}

TEST_CASE_TEMPLATE("an odd and an even term that cancel at one step do not mislead", S, float, double) {
    for (S cancelling = S(0.1); cancelling > S(0.005); cancelling *= S(0.8)) {
        const auto f = [cancelling](S h) { return h + h * h - h * h * h / cancelling; };
        CHECK(taylor_rate(f, S(1)).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("a kink has no slope", S, float, double) {
    const auto kink = [](S h) { return std::abs(h); };
    for (const S slope : {S(-1), S(0), S(1)}) {
        CHECK_FALSE(taylor_rate(kink, slope).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("round-off that hides in a cancellation is seen", S, float, double) {
    // f is small next to 0, its terms are not: round-off is 1000 times that of the value.
    const auto f = [](S h) { return (S(1000) + std::exp(h)) - S(1001); };
    CHECK(taylor_rate(f, S(1)).is_at_least(2));
    CHECK_FALSE(taylor_rate(f, S(1.1)).is_at_least(2));
}

TEST_CASE_TEMPLATE("steps beyond the domain of f are left out", S, float, double) {
    const auto barrier = [](S h) { return std::log(S(0.05) + h); };
    CHECK(taylor_rate(barrier, S(20)).is_at_least(2));
    CHECK_FALSE(taylor_rate(barrier, S(22)).is_at_least(2));
}

TEST_CASE_TEMPLATE("what is not finite has no order", S, float, double) {
    const S nan = std::numeric_limits<S>::quiet_NaN();
    const auto broken = [nan](S) { return nan; };
    CHECK(std::isnan(taylor_rate(broken, S(1)).order));
    CHECK_FALSE(taylor_rate(broken, S(1)).is_at_least(2));
    CHECK_FALSE(taylor_rate([](S h) { return h; }, nan).is_at_least(2));
    const auto infinite_near_zero = [](S h) { return 1 / h; };
    CHECK_FALSE(taylor_rate(infinite_near_zero, S(1)).is_at_least(2));
}

TEST_CASE_TEMPLATE("no false alarm and no miss over many functions", S, float, double) {
    RandomGenerator random(17);
    for (int i = 0; i < 500; ++i) {
        const S a = S(random.uniform(0.5, 2));
        const S b = S(random.uniform(-3, 3));
        const S c = S(random.uniform(-1, 1));
        const S x = S(random.uniform(-2, 2));
        const auto f = [&](S h) { return std::exp(a * (x + h)) + b * std::sin(x + h) + c * (x + h) * (x + h); };
        const S slope = a * std::exp(a * x) + b * std::cos(x) + S(2) * c * x;
        const S curvature = a * a * std::exp(a * x) - b * std::sin(x) + S(2) * c;
        CAPTURE(i);
        CHECK_UNARY(taylor_rate(f, slope).is_at_least(2));
        // An error shows where it outweighs the curvature at the smallest steps.
        const S error = visible_error<S> * std::max(std::max(std::abs(slope), std::abs(curvature)), S(1));
        CHECK_UNARY_FALSE(taylor_rate(f, slope + error).is_at_least(2));
    }
}
