// SPDX-License-Identifier: MIT
#include <softtissue/sparse/block_pattern.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

namespace {
std::vector<std::int32_t> rows(const BlockPattern& pattern, Index column) {
    const auto span = pattern.rows(column);
    return {span.begin(), span.end()};
}
using Rows = std::vector<std::int32_t>;
}  // namespace

TEST_CASE("columns are sorted, without repetition, and hold the diagonal") {
    const BlockPattern pattern({{3, 1, 3, 1}, {0}, {}, {0, 3}});
    CHECK(pattern.num_columns() == 4);
    CHECK(rows(pattern, 0) == Rows{0, 1, 3});
    CHECK(rows(pattern, 1) == Rows{0, 1});
    CHECK(rows(pattern, 2) == Rows{2});
    CHECK(rows(pattern, 3) == Rows{0, 3});
    CHECK(pattern.num_blocks() == 8);
    CHECK(pattern.offset(0) == 0);
    CHECK(pattern.offset(3) == 6);
    CHECK(pattern.offset(4) == 8);
}

TEST_CASE("rank is the place of a row in its column") {
    const BlockPattern pattern({{3, 1}, {0}, {}, {0}});
    CHECK(pattern.rank(0, 0) == 0);
    CHECK(pattern.rank(0, 1) == 1);
    CHECK(pattern.rank(0, 3) == 2);
    CHECK(pattern.rank(3, 3) == 1);
}

TEST_CASE("patterns compare by what they couple") {
    const BlockPattern pattern({{1}, {0}, {}});
    CHECK(pattern == BlockPattern({{1, 1}, {0, 1}, {2}}));
    CHECK_FALSE(pattern == BlockPattern({{2}, {}, {0}}));  // as many blocks, elsewhere
    CHECK_FALSE(pattern == BlockPattern({{}, {}, {}}));
}

TEST_CASE("an empty pattern has no columns") {
    CHECK(BlockPattern().num_columns() == 0);
    CHECK(BlockPattern().num_blocks() == 0);
    CHECK(BlockPattern(std::vector<std::vector<std::int32_t>>{}) == BlockPattern());
}
