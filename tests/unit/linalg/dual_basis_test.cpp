// SPDX-License-Identifier: MIT
#include <softtissue/linalg/dual_basis.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("dual vectors meet their own vector with 1 and the others with 0", Scalar, float, double) {
    RandomGenerator random(1);
    for (int sample = 0; sample < 100; ++sample) {
        const Matrix3<Scalar> B = random_state<Scalar>(StateClass::general, random);
        const Matrix3<Scalar> product = dual_basis(B).transpose() * B;
        // Singular values lie within 0.5 .. 1.6, so the condition number is at most 3.2.
        CHECK((product - Matrix3<Scalar>::Identity()).norm() < 50 * std::numeric_limits<Scalar>::epsilon());
    }
}

TEST_CASE("a symmetric matrix gives its inverse, by exact arithmetic here") {
    Matrix3<double> M;
    M << 2, 1, 0,  //
        1, 1, 0,   //
        0, 0, 4;
    Matrix3<double> inverse;
    inverse << 1, -1, 0,  //
        -1, 2, 0,         //
        0, 0, 0.25;
    CHECK(dual_basis(M) == inverse);
}

TEST_CASE("linearly dependent vectors give no finite dual basis") {
    Matrix3<double> B = Matrix3<double>::Identity();
    B.col(2) = B.col(0);
    CHECK_FALSE(dual_basis(B).allFinite());
}
