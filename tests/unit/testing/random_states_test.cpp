// SPDX-License-Identifier: MIT
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/notation.hpp>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>
#include <limits>
#include <string_view>

using namespace softtissue;

TEST_CASE_TEMPLATE("rotations are rotations, without a preferred direction", S, float, double) {
    RandomGenerator random(5);
    Vector3<double> mean = Vector3<double>::Zero();
    constexpr int count = 4000;
    const S tolerance = 16 * std::numeric_limits<S>::epsilon();
    for (int i = 0; i < count; ++i) {
        const Matrix3<S> R = random_rotation<S>(random);
        CHECK_UNARY((R.transpose() * R - Matrix3<S>::Identity()).norm() <= tolerance);
        CHECK_UNARY(R.determinant() > 0);
        mean += R.col(0).template cast<double>() / count;
    }
    CHECK(mean.norm() < 5 / std::sqrt(double(count)));
}

TEST_CASE_TEMPLATE("unit matrices have unit norm", S, float, double) {
    RandomGenerator random(6);
    for (int i = 0; i < 100; ++i) {
        CHECK(double(random_unit<Matrix3<S>>(random).norm()) ==
              doctest::Approx(1).epsilon(16 * double(std::numeric_limits<S>::epsilon())));
        CHECK(double(random_unit<Vector3<S>>(random).norm()) ==
              doctest::Approx(1).epsilon(16 * double(std::numeric_limits<S>::epsilon())));
    }
}

TEST_CASE_TEMPLATE("each class holds the states it names", S, float, double) {
    RandomGenerator random(11);
    const S epsilon = 64 * std::numeric_limits<S>::epsilon();
    bool met_positive = false, met_negative = false, met_triple = false, met_pair = false;
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(std::string_view(name_of(state_class)));
        for (int sample = 0; sample < 100; ++sample) {
            const Matrix3<S> F = random_state<S>(state_class, random);
            const S J = F.determinant();
            Vector3<S> s = Eigen::JacobiSVD<Matrix3<S>>(F).singularValues();
            s[2] = std::copysign(s[2], J);
            CAPTURE(s.transpose());
            CHECK(s[1] + s[2] >= S(0.1) - epsilon);  // the rotation is well defined
            switch (state_class) {
                case StateClass::identity:
                    CHECK(F == Matrix3<S>::Identity());
                    break;
                case StateClass::near_identity:
                    CHECK((F - Matrix3<S>::Identity()).norm() < S(0.5));
                    break;
                case StateClass::small_strain:
                    CHECK(s[0] <= S(1.01) + epsilon);
                    CHECK(s[2] >= S(0.99) - epsilon);
                    break;
                case StateClass::general:
                    CHECK(s[0] <= S(1.6) + epsilon);
                    CHECK(s[2] >= S(0.5) - epsilon);
                    break;
                case StateClass::large_stretch:
                    CHECK(s[0] >= S(2) - epsilon);
                    CHECK(s[2] > 0);
                    break;
                case StateClass::near_singular:
                    CHECK(std::abs(s[2]) <= S(0.01) + epsilon);
                    (J > 0 ? met_positive : met_negative) = true;
                    break;
                case StateClass::inverted:
                    CHECK(s[2] <= S(-0.1) + epsilon);
                    break;
                case StateClass::gaussian:
                    break;
                case StateClass::equal_stretches:
                    CHECK(std::min(s[0] - s[1], s[1] - s[2]) <= epsilon);
                    (s[0] - s[2] <= epsilon ? met_triple : met_pair) = true;
                    break;
            }
        }
    }
    CHECK(met_positive);
    CHECK(met_negative);
    CHECK(met_triple);
    CHECK(met_pair);
}

TEST_CASE("the classes for barrier laws never turn a state inside out") {
    RandomGenerator random(12);
    for (const StateClass state_class : orientation_preserving_state_classes) {
        for (int sample = 0; sample < 200; ++sample) {
            CHECK(random_state<double>(state_class, random).determinant() > 0.1);
        }
    }
}
