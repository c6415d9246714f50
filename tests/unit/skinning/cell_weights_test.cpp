// SPDX-License-Identifier: MIT
#include <softtissue/skinning/cell_weights.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("a cell takes the mean of its nodes", S, float, double) {
    MatrixX<S> dense(5, 2);
    dense << 1, 0, 0, 1, S(0.5), S(0.5), S(0.25), S(0.75), 1, 0;
    const SkinningWeights<S> weights(dense);
    Connectivity<4> cells(4, 2);
    cells << 0, 4, 1, 4, 2, 4, 3, 0;
    const MatrixX<S> result = cell_weights(weights, cells).dense();
    REQUIRE(result.rows() == 2);
    CHECK(result(0, 0) == S(1.75) / 4);
    CHECK(result(0, 1) == S(2.25) / 4);
    CHECK(result.row(1) == dense.row(4));

    Connectivity<6> prism(6, 1);
    prism << 0, 1, 2, 3, 4, 4;
    const MatrixX<S> of_prism = cell_weights(weights, prism).dense();
    CHECK(std::abs(of_prism(0, 0) - S(3.75) / 6) <= 4 * std::numeric_limits<S>::epsilon());
}

TEST_CASE("a node out of range is refused, with its cell") {
    const SkinningWeights<double> weights(MatrixX<double>::Ones(3, 1));
    Connectivity<4> cells(4, 2);
    cells << 0, 0, 1, 1, 2, 2, 0, 3;
    CHECK_THROWS_WITH_AS(cell_weights(weights, cells), "cell_weights: node 3 of cell 1 is vertex 3, expected 0 to 2",
                         InvalidInput);
}
