// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_gather.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace softtissue;

namespace {

template <int N, class S>
bool gathers() {
    std::array<S, 40> numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        numbers[k] = S(k) - S(0.5);
    }
    std::array<std::int32_t, std::size_t(N)> places;
    for (int i = 0; i < N; ++i) {
        places[std::size_t(i)] = 11 * i % 40 == 0 ? 39 : 11 * i % 40;  // the first repeats itself where N is large
    }
    const Pack<S, N> gathered = gather<N>(numbers.data(), places.data());
    bool all_there = true;
    for (int i = 0; i < N; ++i) {
        all_there = all_there && gathered[i] == numbers[std::size_t(places[std::size_t(i)])];
    }
    return all_there;
}

}  // namespace

TEST_CASE_TEMPLATE("each lane has the number of its place, for every width", S, float, double) {
    CHECK(gathers<1, S>());
    CHECK(gathers<2, S>());
    CHECK(gathers<3, S>());
    CHECK(gathers<4, S>());
    CHECK(gathers<8, S>());
    CHECK(gathers<16, S>());
}
