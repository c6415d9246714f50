// SPDX-License-Identifier: MIT
#include <softtissue/sparse/supernodal_analysis.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

Eigen::SparseMatrix<double> random_pattern(int n, int entries, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<Eigen::Triplet<double>> triplets;
    for (int k = 0; k < entries; ++k) {
        const int i = int(random.index(n));
        const int j = int(random.index(n));
        triplets.emplace_back(i, j, 1.0);
        triplets.emplace_back(j, i, 1.0);
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(triplets.begin(), triplets.end());
    return A;
}

}  // namespace

TEST_CASE("fronts eliminate every pivot once, updates fit into their parents and onto the stacks") {
    for (const int entries : {0, 60, 200}) {
        const SupernodalAnalysis analysis(random_pattern(80, entries, 4));
        REQUIRE(analysis.num_unknowns() == 80);
        Index next_pivot = 0, values = 0;
        for (size_t f = 0; f < analysis.fronts().size(); ++f) {
            const Front& front = analysis.fronts()[f];
            CHECK(front.first_pivot == next_pivot);
            CHECK(front.panel == values);
            next_pivot += front.width;
            values += front.width * front.height;
            CHECK(front.height <= analysis.largest_height());
            const Index below = front.num_rows_below();
            CHECK(Index(analysis.rows(front).size()) == below);
            CHECK(front.update + below * below <= analysis.stack_sizes()[size_t(front.stack)]);
            for (const std::int32_t c : analysis.children(front)) {
                const Front& child = analysis.fronts()[size_t(c)];
                CHECK(size_t(c) < f);
                CHECK(child.stack != front.stack);
                std::int32_t row = 0;
                for (const FrontRun& run : analysis.runs(child)) {
                    CHECK(run.row == row);
                    for (std::int32_t k = 0; k < run.length; ++k, ++row) {
                        const Index in_parent = run.parent_row + k;
                        const Index pivot = in_parent < front.width
                                                ? front.first_pivot + in_parent
                                                : analysis.rows(front)[size_t(in_parent - front.width)];
                        CHECK(pivot == analysis.rows(child)[size_t(row)]);
                    }
                }
                CHECK(row == child.num_rows_below());
            }
        }
        CHECK(next_pivot == 80);
        CHECK(values == analysis.num_values());
    }
}

TEST_CASE("each entry of the lower triangle has its place, on or below the diagonal") {
    const Eigen::SparseMatrix<double> A = random_pattern(60, 150, 9);
    const SupernodalAnalysis analysis(A);
    CHECK(analysis.num_matrix_entries() == A.nonZeros());
    std::vector<int> row_of(size_t(A.nonZeros())), column_of(size_t(A.nonZeros()));
    Index expected = 0;
    for (int j = 0; j < A.cols(); ++j) {
        for (int e = A.outerIndexPtr()[j]; e < A.outerIndexPtr()[j + 1]; ++e) {
            row_of[size_t(e)] = A.innerIndexPtr()[e];
            column_of[size_t(e)] = j;
            expected += A.innerIndexPtr()[e] >= j ? 1 : 0;
        }
    }
    Index found = 0;
    for (const Front& front : analysis.fronts()) {
        for (const FrontEntry& entry : analysis.entries(front)) {
            const Index column = entry.panel_place / front.height;
            const Index row = entry.panel_place % front.height;
            REQUIRE(row >= column);
            const int i = analysis.order()[size_t(front.first_pivot + column)];
            const Index row_pivot =
                row < front.width ? front.first_pivot + row : analysis.rows(front)[size_t(row - front.width)];
            const int j = analysis.order()[size_t(row_pivot)];
            CHECK(std::minmax(i, j) == std::minmax(row_of[size_t(entry.source)], column_of[size_t(entry.source)]));
            ++found;
        }
    }
    CHECK(found == expected);
}

TEST_CASE("only square compressed matrices") {
    CHECK_THROWS_WITH_AS(SupernodalAnalysis(Eigen::SparseMatrix<double>(3, 4)),
                         doctest::Contains("a matrix of 3 rows and 4 columns, expected a square one"), InvalidInput);
    Eigen::SparseMatrix<double> A(3, 3);
    A.coeffRef(0, 0) = 1.0;
    CHECK_THROWS_AS(SupernodalAnalysis{A}, InvalidInput);
}
