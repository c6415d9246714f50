// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/shuffled_order.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace softtissue;

TEST_CASE("every order is a permutation, and the sequence of orders is always the same") {
    ShuffledOrder first(100);
    ShuffledOrder second(100);
    std::vector<std::int32_t> before;
    for (int call = 0; call < 10; ++call) {
        const std::vector<std::int32_t> order = first.next();
        CHECK(order == second.next());
        CHECK(order != before);
        before = order;
        std::vector<std::int32_t> sorted = order;
        std::sort(sorted.begin(), sorted.end());
        for (std::int32_t i = 0; i < 100; ++i) {
            REQUIRE(sorted[size_t(i)] == i);
        }
    }
    CHECK(ShuffledOrder(0).next().empty());
    CHECK(ShuffledOrder(1).next() == std::vector<std::int32_t>{0});
}

TEST_CASE("every number comes everywhere equally often") {
    constexpr int calls = 6000;
    ShuffledOrder shuffled(6);
    std::vector<int> counts(36, 0);
    for (int call = 0; call < calls; ++call) {
        const std::vector<std::int32_t>& order = shuffled.next();
        for (size_t place = 0; place < 6; ++place) {
            ++counts[6 * place + size_t(order[place])];
        }
    }
    // 1000 expected with a deviation of sqrt(6000 (1/6) (5/6)) = 29; five of them.
    for (const int count : counts) {
        CHECK(std::abs(count - 1000) < 145);
    }
}
