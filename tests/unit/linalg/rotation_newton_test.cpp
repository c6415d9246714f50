// SPDX-License-Identifier: MIT
#include <softtissue/linalg/rotation_newton.hpp>

#include <softtissue/linalg/polar.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("from a few degrees every state is reached, inverted ones too", S, float, double) {
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Matrix3<S> F = random_state<S>(state_class, random);
            const Matrix3<S> R = polar_rotation(svd3(F));
            const Vector3<S> turn = S(0.02) * random_unit<Vector3<S>>(random);
            Quaternion<S> q = quaternion_from_rotation_matrix<S>(rotation_matrix_from_rotation_vector<S>(turn) * R);
            CHECK(refine_rotation(F, q));
            CHECK((rotation_matrix_from_quaternion(q) - R).norm() < S(300) * std::numeric_limits<S>::epsilon());
        }
    }
}

TEST_CASE_TEMPLATE("two steps from two degrees, to the last digits", S, float, double) {
    RandomGenerator random(2);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Matrix3<S> F = random_state<S>(StateClass::small_strain, random);
        const Vector3<S> turn = S(0.035) * random_unit<Vector3<S>>(random);
        const Matrix3<S> R = polar_rotation(svd3(F));
        Quaternion<S> q = quaternion_from_rotation_matrix<S>(rotation_matrix_from_rotation_vector<S>(turn) * R);
        CHECK(refine_rotation(F, q, 2));
        CHECK((rotation_matrix_from_quaternion(q) - R).norm() < S(20) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("a step leaves no more than its cube over the smallest resistance to turning") {
    RandomGenerator random(5);
    for (const double gap : {1.9, 1.0, 0.3, 0.05, 0.02}) {
        for (int repeat = 0; repeat < 50; ++repeat) {
            const double middle = gap / 2 + (1 - gap / 2) * random.uniform();
            const Vector3<double> sigma(1, middle, gap - middle);
            const Matrix3<double> V = random_rotation<double>(random), U = random_rotation<double>(random);
            const Matrix3<double> F = U * sigma.asDiagonal() * V.transpose(), R = U * V.transpose();
            const double angle = 3e-3 * gap;
            const Vector3<double> turn = angle * random_unit<Vector3<double>>(random);
            Quaternion<double> q =
                quaternion_from_rotation_matrix<double>(rotation_matrix_from_rotation_vector<double>(turn) * R);
            refine_rotation(F, q, 1);
            const Vector3<double> left =
                rotation_vector_from_rotation_matrix<double>(rotation_matrix_from_quaternion(q) * R.transpose());
            CHECK(left.norm() <=
                  0.25 * angle * angle * angle / gap * 1.05 + 20 * std::numeric_limits<double>::epsilon() / gap);
        }
    }
}

TEST_CASE_TEMPLATE("where it says so, no other rotation is nearer, from any start", S, float, double) {
    RandomGenerator random(3);
    int reached = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Matrix3<S> F = random_state<S>(StateClass::gaussian, random);
        Quaternion<S> q = quaternion_from_rotation_matrix<S>(random_rotation<S>(random));
        if (refine_rotation(F, q)) {
            ++reached;
            const S distance = (F - rotation_matrix_from_quaternion(q)).norm();
            CHECK(distance <=
                  (F - polar_rotation(svd3(F))).norm() * (S(1) + S(100) * std::numeric_limits<S>::epsilon()));
        }
    }
    CHECK(reached > 20);
    CHECK(reached < 300);  // from far away Newton also meets the other stationary rotations
}

TEST_CASE_TEMPLATE("what has no nearest rotation is not reached", S, float, double) {
    using Limits = std::numeric_limits<S>;
    const Quaternion<S> identity(1, 0, 0, 0);
    const Matrix3<S> I = Matrix3<S>::Identity();
    const Matrix3<S> ambiguous = Vector3<S>(S(2), S(1), S(-1)).asDiagonal();
    for (const Matrix3<S>& F : {Matrix3<S>(Matrix3<S>::Zero()), ambiguous, Matrix3<S>(I * Limits::quiet_NaN()),
                                Matrix3<S>(I * (Limits::max() / 2)), Matrix3<S>(I * Limits::min())}) {
        Quaternion<S> q = identity;
        CHECK_FALSE(refine_rotation(F, q));
    }
    Quaternion<S> q = identity;
    CHECK(refine_rotation(I, q));
    CHECK(q == identity);
}
