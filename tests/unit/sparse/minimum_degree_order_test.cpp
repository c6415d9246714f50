// SPDX-License-Identifier: MIT
#include <softtissue/sparse/minimum_degree_order.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace softtissue;

TEST_CASE("the hub of a star goes last but for one ray") {
    std::vector<std::vector<std::int32_t>> neighbours(9);
    for (std::int32_t v = 0; v < 9; ++v) {
        if (v != 4) {
            neighbours[4].push_back(v);
            neighbours[size_t(v)].push_back(4);
        }
    }
    const std::vector<std::int32_t> order = minimum_degree_order(BlockPattern(neighbours));
    REQUIRE(order.size() == 9);
    CHECK(std::find(order.begin(), order.end(), 4) - order.begin() >= 7);
    std::vector<std::int32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::int32_t v = 0; v < 9; ++v) {
        CHECK(sorted[size_t(v)] == v);
    }
}

TEST_CASE("isolated vertices and no vertices at all") {
    CHECK(minimum_degree_order(BlockPattern({{}, {}})).size() == 2);
    CHECK(minimum_degree_order(BlockPattern()).empty());
}
