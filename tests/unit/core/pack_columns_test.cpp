// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_columns.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace softtissue;

namespace {

template <int N, class S>
bool gathers() {
    std::array<S, 60> numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        numbers[k] = S(k) - S(0.5);
    }
    std::array<std::int32_t, std::size_t(N)> places;
    for (int i = 0; i < N; ++i) {
        places[std::size_t(i)] = 11 * i % 53;  // of any remainder, the last of them three before the end
    }
    places[std::size_t(N) - 1] = 56;
    const Vector3<Pack<S, N>> gathered = gather_columns<N>(numbers.data(), places.data());
    std::array<std::int32_t, std::size_t(N)> ends;
    ends.fill(57);
    const Vector3<Pack<S, N>> last = gather_last_columns<N>(numbers.data(), ends.data());
    bool all_there = true;
    for (int i = 0; i < N; ++i) {
        for (int k = 0; k < 3; ++k) {
            all_there = all_there && gathered(k)[i] == numbers[std::size_t(places[std::size_t(i)] + k)] &&
                        last(k)[i] == S(57 + k) - S(0.5);
        }
    }
    return all_there;
}

template <int N, class S>
bool stores() {
    Vector3<Pack<S, N>> packs;
    for (int k = 0; k < 3; ++k) {
        packs(k) = Pack<S, N>::from_lanes([&](int i) { return S(10 * i + k); });
    }
    std::array<S, std::size_t(4 * N + 1)> columns;
    columns.back() = S(-1);
    store_columns(packs, columns.data());
    bool all_there = columns.back() == S(-1);
    for (int i = 0; i < N; ++i) {
        for (int k = 0; k < 4; ++k) {
            all_there = all_there && columns[std::size_t(4 * i + k)] == S(10 * i + std::min(k, 2));
        }
    }
    return all_there;
}

}  // namespace

TEST_CASE_TEMPLATE("each lane has the three numbers at its place, for every width", S, float, double) {
    CHECK(gathers<1, S>());
    CHECK(gathers<2, S>());
    CHECK(gathers<3, S>());
    CHECK(gathers<4, S>());
    CHECK(gathers<8, S>());
    CHECK(gathers<16, S>());
    CHECK(gathers<32, S>());
}

TEST_CASE_TEMPLATE("each column has the three numbers of its lane, for every width", S, float, double) {
    CHECK(stores<1, S>());
    CHECK(stores<2, S>());
    CHECK(stores<3, S>());
    CHECK(stores<4, S>());
    CHECK(stores<8, S>());
    CHECK(stores<16, S>());
    CHECK(stores<32, S>());
}
