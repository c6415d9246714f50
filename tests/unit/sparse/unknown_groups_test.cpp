// SPDX-License-Identifier: MIT
#include <softtissue/sparse/unknown_groups.hpp>

#include <softtissue/sparse/block_matrix.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

Eigen::SparseMatrix<double> matrix_of(int n, const std::vector<std::pair<int, int>>& entries) {
    std::vector<Eigen::Triplet<double>> triplets;
    for (const auto& [row, column] : entries) {
        triplets.emplace_back(row, column, 1.0);
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(triplets.begin(), triplets.end());
    return A;
}

}  // namespace

TEST_CASE("the components of a vertex are one group, the graph is that of the vertices") {
    const BlockPattern pattern({{1}, {0, 2}, {1, 3}, {2}});
    const BlockMatrix<double> A(pattern);
    const UnknownGroups groups(A.matrix());
    REQUIRE(groups.num_groups() == 4);
    CHECK(groups.num_unknowns() == 12);
    for (Index g = 0; g < 4; ++g) {
        CHECK(groups.begin(g) == 3 * g);
        CHECK(groups.size(g) == 3);
    }
    CHECK(groups.graph() == pattern);
}

TEST_CASE("groups may differ in size; neighbours only in part are none") {
    // 0 and 1 alike, both next to 2; 3 is next to 2 only
    const UnknownGroups groups(matrix_of(4, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {3, 2}}));
    REQUIRE(groups.num_groups() == 3);
    CHECK(groups.size(0) == 2);
    CHECK(groups.size(1) == 1);
    CHECK(groups.begin(2) == 3);
    CHECK(groups.graph() == BlockPattern({{1}, {0, 2}, {1}}));
}

TEST_CASE("unknowns without neighbours stay alone, as do alike ones that are not neighbours") {
    CHECK(UnknownGroups(matrix_of(3, {{0, 0}, {1, 1}, {2, 2}})).num_groups() == 3);
    CHECK(UnknownGroups(matrix_of(3, {{2, 0}, {2, 1}})).num_groups() == 3);
    CHECK(UnknownGroups(matrix_of(0, {})).num_groups() == 0);
}

TEST_CASE("the upper triangle is not read") {
    const UnknownGroups groups(matrix_of(3, {{0, 0}, {1, 1}, {2, 2}, {0, 2}}));
    CHECK(groups.graph() == BlockPattern({{}, {}, {}}));
}
