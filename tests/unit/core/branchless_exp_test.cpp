// SPDX-License-Identifier: MIT
#include <softtissue/core/branchless_exp.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// The error of `value` in units of the spacing of numbers at `exact`.
template <class S>
double ulps(S value, long double exact) {
    const S rounded = S(exact);
    const S spacing = std::nextafter(std::abs(rounded), std::numeric_limits<S>::infinity()) - std::abs(rounded);
    return double(std::abs(static_cast<long double>(value) - exact) / static_cast<long double>(spacing));
}

}  // namespace

TEST_CASE_TEMPLATE("within 1.5 ulp wherever the result is a number, subnormal ones included", S, float, double) {
    const bool is_float = sizeof(S) == 4;
    RandomGenerator random(1);
    double worst = 0;
    for (int i = 0; i < 400000; ++i) {
        const double reach = i % 2 == 0 ? 1.0 : (is_float ? 88.0 : 709.0);
        const S x =
            S(i % 4 == 3 ? -1.17 * reach : 1) * S(random.uniform(i % 4 == 3 ? 0 : -reach, i % 4 == 3 ? 1 : reach));
        worst = std::max(worst, ulps(branchless_exp(x), std::exp(static_cast<long double>(x))));
    }
    MESSAGE("largest error in ulp: ", worst);
    CHECK(worst < 1.5);
}

TEST_CASE_TEMPLATE("a correction below the last digit counts", S, float, double) {
    const S epsilon = std::numeric_limits<S>::epsilon();
    for (const S x : {S(-60), S(-20.5), S(3), S(70)}) {
        for (const S low : {S(0.1), S(-0.03), S(20) * epsilon}) {
            const long double exact = std::exp(static_cast<long double>(x) + static_cast<long double>(low));
            CHECK(ulps(branchless_exp(x, low), exact) < 2);
        }
    }
}

TEST_CASE_TEMPLATE("exp(x) - 1 within 2.5 ulp, for small and for large x", S, float, double) {
    RandomGenerator random(2);
    double worst = 0;
    for (int i = 0; i < 400000; ++i) {
        const double reach = i % 2 == 0 ? 1.5 : (sizeof(S) == 4 ? 88.7 : 709.7);
        const double small = i % 8 == 0 ? std::exp(-random.uniform(0, 60)) : 1;
        const S x = S(small * random.uniform(-reach, reach));
        worst = std::max(worst, ulps(branchless_expm1(x), std::expm1(static_cast<long double>(x))));
    }
    MESSAGE("largest error in ulp: ", worst);
    CHECK(worst < 2.5);
    using Limits = std::numeric_limits<S>;
    CHECK(branchless_expm1(Limits::infinity()) == Limits::infinity());
    CHECK(branchless_expm1(-Limits::infinity()) == S(-1));
    CHECK(branchless_expm1(S(0)) == S(0));
    CHECK(branchless_expm1(Limits::denorm_min()) == Limits::denorm_min());
    CHECK(std::isnan(branchless_expm1(Limits::quiet_NaN())));
}

TEST_CASE_TEMPLATE("packs give what plain numbers give, to the last digit but one", P,
                   Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>, Pack<float, 64>,
                   Pack<double, 3>) {
    using T = RealOf<P>;
    RandomGenerator random(3);
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const P x = P::from_lanes([&](int) { return T(random.uniform(-1, 1) * std::exp(random.uniform(-20, 7))); });
        const P power = branchless_exp(x), power_less_1 = branchless_expm1(x);
        for (int i = 0; i < num_lanes<P>; ++i) {
            const T tolerance = 2 * std::numeric_limits<T>::epsilon();
            const T expected = branchless_exp(x[i]), expected_less_1 = branchless_expm1(x[i]);
            REQUIRE((power[i] == expected || std::abs(power[i] - expected) <= tolerance * expected));
            REQUIRE((power_less_1[i] == expected_less_1 ||
                     std::abs(power_less_1[i] - expected_less_1) <= tolerance * std::abs(expected_less_1)));
        }
    }
}

TEST_CASE_TEMPLATE("one at zero, infinite beyond the largest number, zero far below", S, float, double) {
    using Limits = std::numeric_limits<S>;
    CHECK(branchless_exp(S(0)) == S(1));
    CHECK(branchless_exp(S(800)) == Limits::infinity());
    CHECK(branchless_exp(Limits::infinity()) == Limits::infinity());
    CHECK(branchless_exp(Limits::max()) == Limits::infinity());
    CHECK(branchless_exp(S(-800)) == S(0));
    CHECK(branchless_exp(-Limits::infinity()) == S(0));
    CHECK(std::isnan(branchless_exp(Limits::quiet_NaN())));
}
