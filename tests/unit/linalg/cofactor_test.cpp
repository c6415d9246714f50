// SPDX-License-Identifier: MIT
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("determinant and cofactor agree with the inverse", Scalar, float, double) {
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    RandomGenerator random(1);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Matrix3<Scalar> F = random_normal<Matrix3<Scalar>>(random);
        const Matrix3<Scalar> cof = cofactor(F);
        // F^T cof F = J I: sums of products of three entries.
        const Scalar tolerance = Scalar(20) * epsilon * F.norm() * F.norm() * F.norm();
        CHECK((F.transpose() * cof - F.determinant() * Matrix3<Scalar>::Identity()).norm() < tolerance);
        CHECK(std::abs(determinant(F) - F.determinant()) < tolerance);
        CHECK(std::abs(determinant(F, cof) - F.determinant()) < tolerance);
    }
}

TEST_CASE("small integers are exact, singular matrices included") {
    Matrix3<double> F;
    F << 1, 2, 3, 4, 5, 6, 7, 8, 10;
    Matrix3<double> expected;  // minors by hand
    expected << 2, 2, -3, 4, -11, 6, -3, 6, -3;
    CHECK(cofactor(F) == expected);
    CHECK(determinant(F) == -3.0);
    CHECK(determinant(F, cofactor(F)) == -3.0);
    F(2, 2) = 9;
    CHECK(determinant(F) == 0.0);
    CHECK(cofactor<double>(Matrix3<double>::Zero()) == Matrix3<double>::Zero());
}

TEST_CASE_TEMPLATE("the Hessian of the determinant is its exact second difference", Scalar, float, double) {
    // det is linear in each entry, so mixed differences with unit steps are exact for small integers.
    RandomGenerator random(2);
    for (int repeat = 0; repeat < 5; ++repeat) {
        const Matrix3<Scalar> F =
            Matrix3<Scalar>::NullaryExpr([&random] { return Scalar(random.index(9)) - Scalar(4); });
        Matrix9<Scalar> H = Matrix9<Scalar>::Ones();
        add_determinant_hessian(F, Scalar(2), H);
        for (int a = 0; a < 9; ++a) {
            for (int b = 0; b < 9; ++b) {
                const Matrix3<Scalar> A = unvec<Scalar>(Vector9<Scalar>::Unit(a));
                const Matrix3<Scalar> B = unvec<Scalar>(Vector9<Scalar>::Unit(b));
                const Scalar difference = a == b ? Scalar(0)
                                                 : determinant<Scalar>(F + A + B) - determinant<Scalar>(F + A) -
                                                       determinant<Scalar>(F + B) + determinant(F);
                CHECK(H(a, b) == Scalar(1) + Scalar(2) * difference);
            }
        }
    }
}
