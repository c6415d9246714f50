// SPDX-License-Identifier: MIT
#include <softtissue/metric/position_error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("the mean distance over the free vertices, and the worst of them", S, float, double) {
    Matrix3X<S> reference(3, 4);
    reference << 0, 1, 2, 3,  //
        0, 1, 0, 1,           //
        5, 5, 5, 5;
    Matrix3X<S> x = reference;
    x.col(0) += Vector3<S>(100, 0, 0);  // prescribed
    x.col(1) += Vector3<S>(3, 4, 0);
    x.col(3) += Vector3<S>(0, 0, -1);
    const std::vector<std::int32_t> bone{0};
    const PrescribedVertices prescribed(4, bone);
    const PositionError<S> error = position_error(x, reference, prescribed);
    CHECK(error.mean == S(2));
    CHECK(error.largest == S(5));
    CHECK(error.worst_vertex == 1);

    const PositionError<S> none = position_error(reference, reference, prescribed);
    CHECK(none.mean == S(0));
    CHECK(none.worst_vertex == -1);
    x(0, 2) = std::numeric_limits<S>::quiet_NaN();
    CHECK(std::isnan(position_error(x, reference, prescribed).mean));
}

TEST_CASE("a mean over a hundred thousand vertices keeps float's precision") {
    const Index count = 100000;
    const Matrix3X<float> reference = Matrix3X<float>::Zero(3, count);
    const Matrix3X<float> x = Matrix3X<float>::Constant(3, count, 0.1F);
    const PrescribedVertices prescribed(count, {});
    CHECK(position_error(x, reference, prescribed).mean == doctest::Approx(0.1 * std::sqrt(3.0)).epsilon(1e-6));
}

TEST_CASE("without free vertices the error is 0; unequal sizes are refused") {
    const Matrix3X<double> x = Matrix3X<double>::Ones(3, 2);
    const std::vector<std::int32_t> both{0, 1};
    CHECK(position_error<double>(x, Matrix3X<double>(2 * x), PrescribedVertices(2, both)).mean == 0);
    CHECK_THROWS_WITH_AS(position_error<double>(x, x, PrescribedVertices(3, {})),
                         "position error: 2 positions, 2 reference positions, 3 vertices, expected equal numbers",
                         InvalidInput);
}
