// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_shuffle.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// first, first + 1, ...
template <class P>
P counted(int first) {
    return P::from_lanes([&](int i) { return RealOf<P>(first + i); });
}

}  // namespace

TEST_CASE_TEMPLATE("joined: the lanes of one pack, then those of the other", P, Pack<float, 1>, Pack<float, 2>,
                   Pack<float, 3>, Pack<float, 4>, Pack<float, 8>, Pack<float, 16>, Pack<double, 1>, Pack<double, 2>,
                   Pack<double, 4>, Pack<double, 8>, Pack<double, 16>) {
    constexpr int N = num_lanes<P>;
    const auto both = joined(counted<P>(0), counted<P>(N));
    for (int i = 0; i < 2 * N; ++i) {
        CHECK(both[i] == RealOf<P>(i));
    }
}

TEST_CASE_TEMPLATE("chosen: any lanes, any number of them, repeated or not", S, float, double) {
    const auto check = [](const auto& pack, const auto& lanes) {
        CHECK(lanes[0] == pack[3]);
        CHECK(lanes[1] == pack[0]);
        CHECK(lanes[2] == pack[3]);
        CHECK(lanes[3] == pack[1]);
    };
    check(counted<Pack<S, 4>>(5), chosen<3, 0, 3, 1>(counted<Pack<S, 4>>(5)));
    check(counted<Pack<S, 5>>(5), chosen<3, 0, 3, 1>(counted<Pack<S, 5>>(5)));
    check(counted<Pack<S, 8>>(5), chosen<3, 0, 3, 1>(counted<Pack<S, 8>>(5)));
    check(counted<Pack<S, 16>>(5), chosen<3, 0, 3, 1, 15, 14, 7, 8>(counted<Pack<S, 16>>(5)));
    CHECK(chosen<2>(counted<Pack<S, 4>>(5))[0] == S(7));
    CHECK(chosen<15, 0, 12, 3, 7, 6, 5, 4, 11, 10, 9, 8, 1, 2, 13, 14>(counted<Pack<S, 16>>(0))[0] == S(15));
}

TEST_CASE_TEMPLATE("shuffled: any lanes of two packs", P, Pack<float, 1>, Pack<float, 3>, Pack<float, 4>,
                   Pack<float, 8>, Pack<float, 16>, Pack<double, 2>, Pack<double, 4>, Pack<double, 8>,
                   Pack<double, 16>) {
    constexpr int N = num_lanes<P>;
    const auto lane_of = [](int i) { return (5 * i + 3) % (2 * N); };
    const P mixed = shuffled(counted<P>(0), counted<P>(N), lane_of);
    for (int i = 0; i < N; ++i) {
        CHECK(mixed[i] == RealOf<P>(lane_of(i)));
    }
}
