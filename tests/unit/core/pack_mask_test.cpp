// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_mask.hpp>

#include <softtissue/core/pack.hpp>

#include <doctest/doctest.h>

#include <type_traits>

using namespace softtissue;

static_assert(natural_lanes<float> >= natural_lanes<double> && natural_lanes<long double> == 1);
static_assert(std::is_trivially_copyable_v<PackMask<double, 2>>);
static_assert(sizeof(PackMask<float, natural_lanes<float>>) <= sizeof(float) * natural_lanes<float>);

// Packs that fill a register, packs wider than any register, and packs that are no power of two.
TEST_CASE_TEMPLATE("masks combine lane by lane", P, Pack<float, natural_lanes<float>>,
                   Pack<double, natural_lanes<double>>, Pack<float, 64>, Pack<double, 3>) {
    constexpr int N = num_lanes<P>;
    using T = RealOf<P>;
    const auto odd = P::from_lanes([](int i) { return T(i % 2); }) > P(0);
    const auto third = P::from_lanes([](int i) { return T(i % 3); }) == P(2);
    const auto both = odd & third, either = odd | third, even = !odd;
    for (int i = 0; i < N; ++i) {
        CHECK(both[i] == (i % 2 == 1 && i % 3 == 2));
        CHECK(either[i] == (i % 2 == 1 || i % 3 == 2));
        CHECK(even[i] == (i % 2 == 0));
    }
}

TEST_CASE_TEMPLATE("any and all", P, Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>,
                   Pack<float, 64>, Pack<double, 3>) {
    constexpr int N = num_lanes<P>;
    for (int special = 0; special < N; ++special) {
        const P x = P::from_lanes([&](int i) { return RealOf<P>(i == special ? 1 : 0); });
        CHECK(any_of(x > P(0)));
        CHECK(!any_of(x > P(1)));
        CHECK(all_of(x >= P(0)));
        CHECK(all_of(x > P(0)) == (N == 1));
        CHECK(!any_of(!(x < P(2))));
    }
    CHECK(any_of(true));
    CHECK(!all_of(false));
    CHECK(select(true, 1.0, 2.0) == 1.0);
}
