// SPDX-License-Identifier: MIT
#include <softtissue/mesh/adjacency.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

TEST_CASE("rows keep the order of the pairs, empty rows included") {
    const Adjacency adjacency(4, {{2, 7}, {0, 5}, {2, 3}, {0, 9}, {2, 8}});
    const auto row = [&](Index i) {
        return std::vector<std::int32_t>(adjacency.row(i).begin(), adjacency.row(i).end());
    };
    CHECK(adjacency.num_rows() == 4);
    CHECK(row(0) == std::vector<std::int32_t>{5, 9});
    CHECK(row(1).empty());
    CHECK(row(2) == std::vector<std::int32_t>{7, 3, 8});
    CHECK(row(3).empty());
    CHECK(Adjacency().num_rows() == 0);
}
