// SPDX-License-Identifier: MIT
#include <softtissue/material/orthonormal.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace softtissue;

TEST_CASE_TEMPLATE("rotations and reflections pass, also those that were stored in float", Scalar, float, double) {
    RandomGenerator random(1);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Matrix3<Scalar> B = random_rotation<double>(random).cast<float>().cast<Scalar>();
        CHECK_NOTHROW(require_orthonormal(B, "basis"));
        CHECK_NOTHROW(require_orthonormal<Scalar>(-B, "basis"));
    }
}

TEST_CASE_TEMPLATE("both sides of the tolerance, and NaN", Scalar, float, double) {
    Matrix3<Scalar> B = Matrix3<Scalar>::Identity();
    B(0, 1) = Scalar(0.9e-5);
    CHECK_NOTHROW(require_orthonormal(B, "basis"));
    B(0, 1) = Scalar(1.1e-5);
    CHECK_THROWS_AS(require_orthonormal(B, "basis"), InvalidInput);
    B(0, 1) = std::numeric_limits<Scalar>::quiet_NaN();
    CHECK_THROWS_AS(require_orthonormal(B, "basis"), InvalidInput);
    CHECK_THROWS_AS(require_orthonormal<Scalar>(Matrix3<Scalar>::Zero(), "basis"), InvalidInput);
}

TEST_CASE("the message names the basis, the columns and the value") {
    const Matrix3<double> B = Vector3<double>(1, 2, 1).asDiagonal();
    std::string text;
    try {
        require_orthonormal(B, "basis of cell ", 17);
    } catch (const InvalidInput& error) {
        text = error.what();
    }
    CHECK(text == "basis of cell 17: column 1 times column 1 = 4, expected 1 (orthonormal)");
}
