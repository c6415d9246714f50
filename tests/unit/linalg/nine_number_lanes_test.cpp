// SPDX-License-Identifier: MIT
#include <softtissue/linalg/nine_number_lanes.hpp>

#include <doctest/doctest.h>

#include <cstddef>

using namespace softtissue;

TEST_CASE_TEMPLATE("every number goes to its lane, and back to its place", S, float, double) {
    constexpr std::size_t n = 32;
    S columns[9 * n], lanes[9][n], back[9 * n + 1];
    for (std::size_t k = 0; k < 9 * n; ++k) {
        columns[k] = S(k);
    }
    columns_to_lanes(columns, lanes);
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t l = 0; l < n; ++l) {
            CHECK(lanes[i][l] == S(9 * l + i));
        }
    }
    back[9 * n] = S(-1);
    lanes_to_columns(lanes, back);
    for (std::size_t k = 0; k < 9 * n; ++k) {
        CHECK(back[k] == columns[k]);
    }
    CHECK(back[9 * n] == S(-1));
}

TEST_CASE_TEMPLATE("three columns fill no register", S, float, double) {
    S columns[27], lanes[9][3], back[27];
    for (std::size_t k = 0; k < 27; ++k) {
        columns[k] = S(k);
    }
    columns_to_lanes(columns, lanes);
    CHECK(lanes[0][2] == S(18));
    CHECK(lanes[8][1] == S(17));
    lanes_to_columns(lanes, back);
    for (std::size_t k = 0; k < 27; ++k) {
        CHECK(back[k] == columns[k]);
    }
}

TEST_CASE("columns of any alignment") {
    constexpr std::size_t n = 16;
    float numbers[9 * n + 3], lanes[9][n];
    for (std::size_t k = 0; k < 9 * n + 3; ++k) {
        numbers[k] = float(k);
    }
    columns_to_lanes(numbers + 3, lanes);
    CHECK(lanes[8][15] == 146.0F);
    lanes_to_columns(lanes, numbers + 1);
    for (std::size_t k = 0; k < 9 * n; ++k) {
        CHECK(numbers[k + 1] == float(k + 3));
    }
    CHECK(numbers[0] == 0.0F);
}
