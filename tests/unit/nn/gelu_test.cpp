// SPDX-License-Identifier: MIT
#include <softtissue/nn/gelu.hpp>

#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

using namespace softtissue;

namespace {

long double exact(Gelu, long double x) {
    return x * std::erfc(-x / std::numbers::sqrt2_v<long double>) / 2;
}
long double exact(TanhGelu, long double x) {
    const long double a = std::sqrt(2 / std::numbers::pi_v<long double>) * (x + 0.044715L * x * x * x);
    return x / (1 + std::exp(-2 * a));
}

}  // namespace

TEST_CASE_TEMPLATE("values keep their relative accuracy, negative ones too", A, Gelu, TanhGelu) {
    const auto worst_error = [](auto limit, double tolerance) {
        using S = decltype(limit);
        double worst = 0;
        for (double x = double(-limit); x <= double(limit); x += 0.00371) {
            const auto reference = exact(A{}, static_cast<long double>(S(x)));
            worst = std::max(worst, double(std::abs(static_cast<long double>(A::at(S(x)).value) / reference - 1)));
        }
        CHECK(worst < tolerance);
    };
    // the exponent of the tanh form is a rounded product: its error grows with its size
    worst_error(5.0, std::is_same_v<A, Gelu> ? 2e-15 : 2e-14);
    worst_error(5.0F, std::is_same_v<A, Gelu> ? 6e-7 : 6e-6);
    worst_error(std::is_same_v<A, Gelu> ? 30.0 : 15.0, std::is_same_v<A, Gelu> ? 2e-15 : 1e-13);
}

TEST_CASE_TEMPLATE("the slope is the derivative", A, Gelu, TanhGelu) {
    for (const double x : {-6.0, -1.3, -0.2, 0.0, 0.4, 2.0, 5.0}) {
        const auto along = [x](double h) { return A::at(x + h).value; };
        CHECK(taylor_rate(along, A::at(x).slope).is_at_least(2));
        CHECK(!taylor_rate(along, A::at(x).slope + 0.001).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("nothing for large negative numbers, the number itself for large ones", S, float, double) {
    const S huge = S(1e30);
    for (const auto& [value, slope] : {Gelu::at(huge), TanhGelu::at(huge)}) {
        CHECK(value == huge);
        CHECK(slope == S(1));
    }
    for (const auto& [value, slope] : {Gelu::at(-huge), TanhGelu::at(-huge)}) {
        CHECK(std::abs(value) <= S(1e-7));
        CHECK(std::abs(slope) <= S(1e-30));
    }
    CHECK(Gelu::at(S(0)).value == S(0));
    CHECK(Gelu::at(S(0)).slope == doctest::Approx(0.5).epsilon(4 * double(std::numeric_limits<S>::epsilon())));
    CHECK(std::isnan(Gelu::at(std::numeric_limits<S>::quiet_NaN()).value));
    CHECK(std::isnan(TanhGelu::at(std::numeric_limits<S>::quiet_NaN()).value));
}

TEST_CASE("the two forms are different functions") {
    CHECK(std::abs(Gelu::at(-2.0).value - TanhGelu::at(-2.0).value) > 5e-5);
    CHECK(std::abs(Gelu::at(-2.0).value - TanhGelu::at(-2.0).value) < 5e-4);
}
