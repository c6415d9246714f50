// SPDX-License-Identifier: MIT
#include <softtissue/mesh/umbrella_mean.hpp>

#include "small_meshes.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("one round is the mean over the neighbours", S, float, double) {
    const softtissue_test::SquareMesh square = softtissue_test::make_square(3);
    const TriangleMesh mesh(square.triangles, square.positions.cols());
    RandomGenerator random(1);
    Eigen::Matrix<S, 2, Eigen::Dynamic> values(2, mesh.num_vertices());
    for (S& value : values.reshaped()) {
        value = S(random.normal());
    }
    std::vector<bool> held(size_t(mesh.num_vertices()), false);
    held[5] = true;
    const Eigen::Matrix<S, 2, Eigen::Dynamic> smoothed = umbrella_smoothed<S, 2>(mesh, values, 1, held);
    for (Index v = 0; v < mesh.num_vertices(); ++v) {
        Eigen::Matrix<S, 2, 1> mean = Eigen::Matrix<S, 2, 1>::Zero();
        for (const std::int32_t w : mesh.neighbours(v)) {
            mean += values.col(w) / S(mesh.neighbours(v).size());
        }
        if (held[size_t(v)]) {
            mean = values.col(v);
        }
        CHECK((smoothed.col(v) - mean).norm() <= S(8) * std::numeric_limits<S>::epsilon() * values.norm());
    }
}

TEST_CASE_TEMPLATE("many rounds even out; none change nothing; a vertex alone keeps its value", S, float, double) {
    softtissue_test::SquareMesh square = softtissue_test::make_square(3);
    const Index n = square.positions.cols() + 1;  // one vertex without triangles
    const TriangleMesh mesh(square.triangles, n);
    Matrix3X<S> values = Matrix3X<S>::Zero(3, n);
    values.col(0).setConstant(S(1));
    values.col(n - 1).setConstant(S(7));
    CHECK(umbrella_smoothed<S, 3>(mesh, values, 0) == values);
    const Matrix3X<S> smoothed = umbrella_smoothed<S, 3>(mesh, values, 200);
    CHECK(smoothed.col(n - 1) == values.col(n - 1));
    // The stationary value weighs vertex 0 by its share of the edge ends.
    S ends(0);
    for (Index v = 0; v < n; ++v) {
        ends += S(mesh.neighbours(v).size());
    }
    const S level = S(mesh.neighbours(0).size()) / ends;
    CHECK((smoothed.leftCols(n - 1).array() - level).abs().maxCoeff() < S(1e-5));
}
