// SPDX-License-Identifier: MIT
#include <softtissue/skinning/surface_carrier.hpp>

#include "arm_body.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using softtissue_test::arm_body;

namespace {

/// Three volume vertices: one of the surface, the mean of two, and one extrapolated (weights 1.5 and -0.5).
template <class S>
struct Extrapolation {
    MatrixX<S> operator()(const MatrixX<S>& known) const {
        MatrixX<S> result(3, known.cols());
        result.row(0) = (known.row(0) + known.row(1)) / S(2);
        result.row(1) = S(7) * known.row(0);  // wrong on purpose: this vertex is matched
        result.row(2) = S(1.5) * known.row(0) - S(0.5) * known.row(1);
        return result;
    }
};

const std::vector<VertexMatch> one_match{{1, 9}};

}  // namespace

static_assert(FieldInterpolator<Extrapolation<double>, double>);
static_assert(!FieldInterpolator<int, double>);

TEST_CASE_TEMPLATE("matched rows are the surface's, whatever the interpolator says", S, float, double) {
    const SmplBody<S> body = arm_body<S>(3);
    const std::vector<VertexMatch> matches{{1, 9}, {0, 4}};
    const auto constant = [](const MatrixX<S>& known) { return MatrixX<S>::Constant(3, known.cols(), S(0.25)).eval(); };
    const SurfaceCarrier<S, decltype(constant)> carrier(18, 3, matches, constant);
    const SkinningWeights<S> weights = carrier.weights(body.weights);
    CHECK(weights.dense().row(1) == body.weights.dense().row(9));
    CHECK(weights.dense().row(0) == body.weights.dense().row(4));
    CHECK(weights.dense().row(2) == MatrixX<S>::Constant(1, 4, S(0.25)));
    const MatrixX<S> shapes = carrier.shape_directions(body.shape_directions);
    CHECK(shapes.middleRows(3, 3) == body.shape_directions.middleRows(27, 3));
    CHECK(shapes.bottomRows(3) == MatrixX<S>::Constant(3, 2, S(0.25)));
    const MatrixX<S> pose = carrier.pose_directions(body.pose_directions).toDense();
    CHECK(pose.topRows(3) == body.pose_directions.toDense().middleRows(12, 3));
    CHECK(pose.middleRows(3, 3) == body.pose_directions.toDense().middleRows(27, 3));
    CHECK(pose.bottomRows(3) == MatrixX<S>::Constant(3, 27, S(0.25)));
}

TEST_CASE_TEMPLATE("negative and tiny interpolated weights are dropped and the rest normalised", S, float, double) {
    MatrixX<S> dense(2, 3);
    dense << S(0.5), S(0.4999), S(0.0001), S(0.9), S(0.1), 0;
    const std::vector<VertexMatch> matches{{1, 0}, {0, 1}};
    const auto extrapolate = [](const MatrixX<S>& known) {
        MatrixX<S> result = MatrixX<S>::Zero(3, known.cols());
        result.row(2) = S(-1.5) * known.row(0) + S(2.5) * known.row(1);  // (1.5, -0.49985, -0.00015)
        return result;
    };
    const SurfaceCarrier<S, decltype(extrapolate)> carrier(2, 3, matches, extrapolate);
    const MatrixX<S> carried = carrier.weights(SkinningWeights<S>(dense)).dense();
    CHECK(carried.row(2) == Eigen::Matrix<S, 1, 3>(1, 0, 0));

    const auto mean = [](const MatrixX<S>& known) {
        MatrixX<S> result = MatrixX<S>::Zero(3, known.cols());
        result.row(2) = (known.row(0) + known.row(1)) / S(2);  // (0.7, 0.29995, 0.00005)
        return result;
    };
    const SurfaceCarrier<S, decltype(mean)> mean_carrier(2, 3, matches, mean);
    CHECK(mean_carrier.weights(SkinningWeights<S>(dense)).row(2).size() == 2);
    const SurfaceCarrier<S, decltype(mean)> keeps_all(2, 3, matches, mean, {.smallest_weight = 0});
    CHECK(keeps_all.weights(SkinningWeights<S>(dense)).row(2).size() == 3);
    CHECK(keeps_all.weights(SkinningWeights<S>(dense)).row(1).size() == 3);
}

TEST_CASE_TEMPLATE("tiny interpolated pose blend shapes are dropped, tiny ones of the surface kept", S, float, double) {
    MatrixX<S> directions = MatrixX<S>::Zero(6, 9);
    directions(1, 2) = S(1e-7);
    directions(4, 5) = S(1e-3);
    const typename SmplBody<S>::SparseMatrix sparse = directions.sparseView(S(1e-30), S(1));
    const std::vector<VertexMatch> matches{{0, 0}, {1, 1}};
    const auto mean = [](const MatrixX<S>& known) {
        MatrixX<S> result = MatrixX<S>::Zero(3, known.cols());
        result.row(2) = (known.row(0) + known.row(1)) / S(2);
        return result;
    };
    const SurfaceCarrier<S, decltype(mean)> carrier(2, 3, matches, mean);
    const MatrixX<S> carried = carrier.pose_directions(sparse).toDense();
    CHECK(carried.topRows(6) == directions);
    CHECK(carried(7, 2) == S(0));
    CHECK(carried(7, 5) == S(0.5e-3));
    const SurfaceCarrier<S, decltype(mean)> keeps_all(2, 3, matches, mean, {.smallest_pose_direction = 0});
    CHECK(keeps_all.pose_directions(sparse).toDense()(7, 2) == S(0.5e-7));
}

TEST_CASE("bad matches and bad interpolations are refused, with the vertex") {
    const SmplBody<double> body = arm_body<double>(3);
    const auto zero = [](const MatrixX<double>& known) { return MatrixX<double>::Zero(3, known.cols()).eval(); };
    using Carrier = SurfaceCarrier<double, decltype(zero)>;
    const std::vector<VertexMatch> outside{{0, 0}, {3, 1}}, no_vertex{{0, 18}}, twice{{2, 1}, {2, 3}};
    CHECK_THROWS_WITH_AS(Carrier(18, 3, outside, zero),
                         "surface carrier: match of volume vertex 3 with surface vertex 1, expected below 3 and 18",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(Carrier(18, 3, no_vertex, zero),
                         "surface carrier: match of volume vertex 0 with surface vertex 18, expected below 3 and 18",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(
        Carrier(18, 800000000, twice, zero),
        "surface carrier: coordinates of the volume = 2400000000, expected 0 to 2147483647 (indices are 32-bit)",
        InvalidInput);
    CHECK_THROWS_WITH_AS(Carrier(18, 3, twice, zero), "surface carrier: volume vertex 2 is matched twice",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(Carrier(18, 3, one_match, zero).weights(body.weights),
                         "surface carrier: interpolated weights of volume vertex 0 sum to 0, expected > 0",
                         InvalidInput);
    const auto nan = [](const MatrixX<double>& known) {
        return MatrixX<double>::Constant(3, known.cols(), std::numeric_limits<double>::quiet_NaN()).eval();
    };
    CHECK_THROWS_WITH_AS((SurfaceCarrier<double, decltype(nan)>(18, 3, one_match, nan).weights(body.weights)),
                         "surface carrier: interpolated value at volume vertex 0 is not finite", InvalidInput);
    const auto short_one = [](const MatrixX<double>& known) { return known; };
    CHECK_THROWS_WITH_AS(
        (SurfaceCarrier<double, decltype(short_one)>(18, 3, one_match, short_one).weights(body.weights)),
        "surface carrier: interpolation is 1 x 4, expected 3 x 4", InvalidInput);
}
