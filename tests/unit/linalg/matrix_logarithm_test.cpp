// SPDX-License-Identifier: MIT
#include <softtissue/linalg/matrix_logarithm.hpp>

#include "exponential_reference.hpp"

#include <softtissue/linalg/quaternion.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
Matrix3<S> diagonal(S a, S b, S c) {
    return Vector3<S>(a, b, c).asDiagonal();
}

}  // namespace

TEST_CASE_TEMPLATE("undoes the exponential of matrices of every kind", S, float, double) {
    RandomGenerator random(1);
    const double epsilon = double(std::numeric_limits<S>::epsilon());
    for (const double norm : {0.0, 1e-6, 0.1, 1.0, 3.0}) {
        double worst = 0;
        for (int i = 0; i < 600; ++i) {
            const Matrix3<S> Q = random_matrix_of_kind<S>(random, i % num_matrix_kinds, norm);
            const std::optional<Matrix3<S>> log = matrix_logarithm<S>(matrix_exponential(Q));
            REQUIRE(log.has_value());
            // the rounding of exp Q moves the logarithm by up to epsilon |exp Q| |exp -Q|
            worst = std::max(worst, double((*log - Q).norm()) / (epsilon * std::exp(2 * norm)));
        }
        CAPTURE(norm);
        CHECK(worst <= 4);
    }
    CHECK(matrix_logarithm<S>(Matrix3<S>::Identity())->norm() == S(0));
}

TEST_CASE_TEMPLATE("the rotation vector of rotations up to next to pi", S, float, double) {
    RandomGenerator random(2);
    for (const double angle : {0.5, 2.0, 3.0, 3.13}) {
        const Vector3<S> axis = random_unit<Vector3<S>>(random), r = S(angle) * axis;
        const std::optional<Matrix3<S>> log = matrix_logarithm(rotation_matrix_from_rotation_vector(r));
        REQUIRE(log.has_value());
        const Vector3<S> found((*log)(2, 1), (*log)(0, 2), (*log)(1, 0));
        const double to_pi = std::numbers::pi - angle;
        CHECK(double((found - r).norm()) <= 40 * double(std::numeric_limits<S>::epsilon()) / (to_pi * to_pi));
    }
}

TEST_CASE_TEMPLATE("strong stretches", S, float, double) {
    const std::optional<Matrix3<S>> log = matrix_logarithm(diagonal<S>(S(1e-10), S(1e8), S(3)));
    REQUIRE(log.has_value());
    CHECK((*log - diagonal<S>(std::log(S(1e-10)), std::log(S(1e8)), std::log(S(3)))).norm() <=
          S(400) * std::numeric_limits<S>::epsilon());
}

TEST_CASE_TEMPLATE("no value where there is no principal logarithm", S, float, double) {
    CHECK(!matrix_logarithm(diagonal<S>(1, 1, -1)));
    CHECK(!matrix_logarithm(diagonal<S>(1, 1, 0)));
    CHECK(!matrix_logarithm(diagonal<S>(-1, -1, 1)));
    CHECK(!matrix_logarithm(diagonal<S>(-1, S(-2), 1)));
    CHECK(!matrix_logarithm(diagonal<S>(std::numeric_limits<S>::quiet_NaN(), 1, 1)));
    CHECK(!matrix_logarithm(diagonal<S>(std::numeric_limits<S>::infinity(), 1, 1)));
    RandomGenerator random(3);
    for (int i = 0; i < 50; ++i) {
        const Matrix3<S> V = random_rotation<S>(random) * diagonal<S>(1, S(1.5), S(0.6));
        const Matrix3<S> F = V * diagonal<S>(S(-random.uniform(0.1, 2)), S(-random.uniform(0.1, 2)), 1) * V.inverse();
        const std::optional<Matrix3<S>> log = matrix_logarithm(F);
        CHECK(!log.has_value());
    }
}
