// SPDX-License-Identifier: MIT
#include <softtissue/nn/normal_distribution.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

using Exact = long double;

Exact exact_cumulative(Exact x) {
    return std::erfc(-x / std::numbers::sqrt2_v<Exact>) / 2;
}
Exact exact_density(Exact x) {
    return std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi_v<Exact>);
}

/// Relative to the exact value, or to the smallest normal number below that, in epsilons.
template <class S>
double error(S value, Exact exact) {
    using Limits = std::numeric_limits<S>;
    const Exact scale = std::max(std::abs(exact), static_cast<Exact>(Limits::min()));
    return double(std::abs(static_cast<Exact>(value) - exact) / scale / static_cast<Exact>(Limits::epsilon()));
}

}  // namespace

TEST_CASE_TEMPLATE("both tails to a few ulp of themselves", S, float, double) {
    RandomGenerator random(2);
    double cumulative = 0, density = 0;
    for (int i = 0; i < 300000; ++i) {
        const S x = S(random.uniform(-1, 1) * (i % 3 == 0 ? 1 : i % 3 == 1 ? 6 : 40));
        const NormalDistribution<S> normal = normal_distribution(x);
        cumulative = std::max(cumulative, error(normal.cumulative, exact_cumulative(static_cast<Exact>(x))));
        density = std::max(density, error(normal.density, exact_density(static_cast<Exact>(x))));
    }
    MESSAGE("largest errors in epsilons: cumulative ", cumulative, ", density ", density);
    CHECK(cumulative < 4);
    CHECK(density < 4);
}

TEST_CASE_TEMPLATE("symmetric, and certain far out", S, float, double) {
    for (const S x : {S(0), S(0.25), S(1), S(3), S(1000)}) {
        CHECK(normal_distribution(x).density == normal_distribution(-x).density);
        CHECK(normal_distribution(x).cumulative + normal_distribution(-x).cumulative ==
              doctest::Approx(1).epsilon(4 * double(std::numeric_limits<S>::epsilon())));
    }
    CHECK(normal_distribution(S(1000)).cumulative == S(1));
    CHECK(normal_distribution(S(-1000)).cumulative == S(0));
    CHECK(normal_distribution(S(1000)).density == S(0));
}

TEST_CASE("the density is the derivative of the cumulative distribution") {
    for (const double x : {-3.0, -0.5, 0.0, 0.7, 2.0}) {
        const auto along = [x](double h) { return normal_distribution(x + h).cumulative; };
        CHECK(taylor_rate(along, normal_distribution(x).density).is_at_least(2));
        CHECK(!taylor_rate(along, 1.01 * normal_distribution(x).density).is_at_least(2));
    }
}
