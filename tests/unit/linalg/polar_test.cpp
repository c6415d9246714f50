// SPDX-License-Identifier: MIT
#include <softtissue/linalg/polar.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("the rotation is proper and F is a symmetric matrix in its frame", Scalar, float, double) {
    constexpr Scalar tolerance = Scalar(60) * std::numeric_limits<Scalar>::epsilon();
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<Scalar> R = polar_rotation(F);
            CHECK((R.transpose() * R - Matrix3<Scalar>::Identity()).norm() < tolerance);
            CHECK(R.determinant() > Scalar(0));
            const Matrix3<Scalar> S = R.transpose() * F;
            CHECK((S - S.transpose()).norm() < tolerance * F.norm());
        }
    }
}

TEST_CASE_TEMPLATE("no other rotation is nearer", Scalar, float, double) {
    RandomGenerator random(2);
    for (const StateClass state_class : {StateClass::general, StateClass::inverted, StateClass::gaussian}) {
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Scalar distance = (F - polar_rotation(F)).norm();
            for (int other = 0; other < 200; ++other) {
                CHECK((F - random_rotation<Scalar>(random)).norm() >= distance);
            }
        }
    }
}

TEST_CASE_TEMPLATE("the derivative of the rotation is that of its Taylor series", Scalar, float, double) {
    RandomGenerator random(3);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 4; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<Scalar> D = random_unit<Matrix3<Scalar>>(random);
            const Matrix9<Scalar> derivative = drotation_dgradient(F);
            CHECK(derivative == derivative.transpose());
            const auto rotation = [&](Scalar h) { return vec<Scalar>(polar_rotation<Scalar>(F + h * D)); };
            const TaylorRate rate = taylor_rate(rotation, Vector9<Scalar>(derivative * vec(D)));
            CHECK(rate.is_at_least(2));
        }
    }
}

TEST_CASE_TEMPLATE("the derivative turns with F and ignores stretching", Scalar, float, double) {
    RandomGenerator random(4);
    const Matrix3<Scalar> F = random_state<Scalar>(StateClass::general, random);
    const Matrix3<Scalar> R = polar_rotation(F);
    const Matrix3<Scalar> symmetric = R.transpose() * F;
    constexpr Scalar tolerance = Scalar(100) * std::numeric_limits<Scalar>::epsilon();
    // F + h F keeps R.
    CHECK((drotation_dgradient(F) * vec(F)).norm() < tolerance);
    // At rest dR = skew(dF).
    Matrix3<Scalar> D = random_normal<Matrix3<Scalar>>(random);
    const Vector9<Scalar> turned = drotation_dgradient<Scalar>(Matrix3<Scalar>::Identity()) * vec(D);
    const Matrix3<Scalar> skew = (D - D.transpose()) / Scalar(2);
    CHECK((turned - vec(skew)).norm() < tolerance);
    CHECK((symmetric - symmetric.transpose()).norm() < tolerance);
}

TEST_CASE_TEMPLATE("where the rotation is not unique it is still a rotation, and its derivative finite", Scalar, float,
                   double) {
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    const Matrix3<Scalar> ambiguous = Vector3<Scalar>(Scalar(2), Scalar(1), Scalar(-1)).asDiagonal();
    const Matrix3<Scalar> rank_one = Vector3<Scalar>(Scalar(2), Scalar(0), Scalar(0)).asDiagonal();
    const Matrix3<Scalar> zero = Matrix3<Scalar>::Zero();
    for (const Matrix3<Scalar>& F : {ambiguous, rank_one, zero}) {
        const Matrix3<Scalar> R = polar_rotation(F);
        CHECK((R.transpose() * R - Matrix3<Scalar>::Identity()).norm() < Scalar(60) * epsilon);
        CHECK(R.determinant() > Scalar(0));
        CHECK(drotation_dgradient(F).allFinite());
    }
    // Both sides of the floor.
    CHECK(twist_denominator<Scalar>({Scalar(1), Scalar(0), Scalar(0)}, 1, 2) == epsilon);
    CHECK(twist_denominator<Scalar>({Scalar(1), Scalar(2) * epsilon, Scalar(0)}, 1, 2) == Scalar(2) * epsilon);
}
