// SPDX-License-Identifier: MIT
#include <softtissue/skinning/weights.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("rows keep what is not zero, ascending by joint", S, float, double) {
    MatrixX<S> dense(3, 3);
    dense << 1, 0, 0, 0, S(0.25), S(0.75), S(0.5), 0, S(0.5);
    const SkinningWeights<S> weights(dense);
    CHECK(weights.num_vertices() == 3);
    CHECK(weights.num_joints() == 3);
    REQUIRE(weights.row(1).size() == 2);
    CHECK(weights.row(1)[0].joint == 1);
    CHECK(weights.row(1)[1].joint == 2);
    CHECK(weights.row(1)[1].weight == S(0.75));
    CHECK(weights.row(0).size() == 1);
    CHECK(weights.dense() == dense);
    CHECK(SkinningWeights<S>().num_vertices() == 0);
}

TEST_CASE_TEMPLATE("rows within the tolerance are normalised, and then stay as they are", S, float, double) {
    MatrixX<S> dense(1, 3);
    dense << S(0.3), S(0.3), S(0.40005);
    const SkinningWeights<S> once(dense);
    CHECK(std::abs(once.dense().sum() - S(1)) <= 3 * std::numeric_limits<S>::epsilon());
    CHECK(once.dense()(0, 0) < S(0.3));
    const SkinningWeights<S> twice(once.dense());
    CHECK(twice.dense() == once.dense());
}

TEST_CASE_TEMPLATE("bad weights are refused, with vertex and value", S, float, double) {
    MatrixX<S> dense(2, 2);
    dense << 1, 0, S(1.5), S(-0.5);
    CHECK_THROWS_WITH_AS(SkinningWeights<S>{dense}, "weights[1, 1] = -0.5, expected a finite value >= 0", InvalidInput);
    dense(1, 1) = std::numeric_limits<S>::quiet_NaN();
    CHECK_THROWS_WITH_AS(SkinningWeights<S>{dense}, "weights[1, 1] = nan, expected a finite value >= 0", InvalidInput);
    dense.row(1) << S(0.5), S(0.25);
    CHECK_THROWS_WITH_AS(SkinningWeights<S>{dense}, "weights of vertex 1 sum to 0.75, expected 1", InvalidInput);
    dense.row(1).setZero();
    CHECK_THROWS_WITH_AS(SkinningWeights<S>{dense}, "weights of vertex 1 sum to 0, expected 1", InvalidInput);
}

TEST_CASE_TEMPLATE("rows of pairs are taken as they are", S, float, double) {
    using Rows = std::vector<std::vector<JointWeight<S>>>;
    const SkinningWeights<S> weights(3, Rows{{{0, S(1)}}, {{1, S(0.25)}, {2, S(0.75)}}});
    MatrixX<S> dense(2, 3);
    dense << 1, 0, 0, 0, S(0.25), S(0.75);
    CHECK(weights.dense() == dense);
    CHECK(weights.num_joints() == 3);
    CHECK(std::abs(SkinningWeights<S>(1, Rows{{{0, S(1.00005)}}}).dense()(0, 0) - S(1)) == S(0));
    const auto refused = [](const Rows& rows) { return SkinningWeights<S>(3, rows).num_vertices(); };
    CHECK_THROWS_WITH_AS(refused({{{0, S(1)}}, {{3, S(1)}}}), "weights of vertex 1: joint 3, expected 0 to 2",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(refused({{{1, S(0.5)}, {1, S(0.5)}}}), "weights of vertex 0: joint 1, expected 2 to 2",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(refused({{{-1, S(1)}}}), "weights of vertex 0: joint -1, expected 0 to 2", InvalidInput);
    CHECK_THROWS_WITH_AS(refused({{{1, S(0)}}}), "weights[0, 1] = 0, expected a finite value > 0", InvalidInput);
    CHECK_THROWS_WITH_AS(refused({{{1, S(0.75)}}}), "weights of vertex 0 sum to 0.75, expected 1", InvalidInput);
    CHECK_THROWS_WITH_AS(refused({{}}), "weights of vertex 0 sum to 0, expected 1", InvalidInput);
}
