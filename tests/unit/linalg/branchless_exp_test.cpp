// SPDX-License-Identifier: MIT
#include <softtissue/linalg/branchless_exp.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
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
