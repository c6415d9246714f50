// SPDX-License-Identifier: MIT
#include <softtissue/linalg/rotation_start.hpp>

#include <softtissue/linalg/polar.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
S error(const Matrix3<S>& F) {
    return (rotation_matrix_from_quaternion(rotation_start(F)) - polar_rotation(svd3(F))).norm();
}

}  // namespace

TEST_CASE_TEMPLATE("rotations come back, half turns too, whatever their size", S, float, double) {
    RandomGenerator random(1);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const Matrix3<S> R = random_rotation<S>(random);
        for (const S size : {S(1), S(1e-6), S(1e6)}) {
            CHECK(error<S>(size * R) < S(300) * std::numeric_limits<S>::epsilon());
        }
    }
    CHECK(error<S>(Matrix3<S>::Identity()) < S(8) * std::numeric_limits<S>::epsilon());
    for (int axis = 0; axis < 3; ++axis) {
        const Matrix3<S> half_turn =
            S(2) * Vector3<S>::Unit(axis) * Vector3<S>::Unit(axis).transpose() - Matrix3<S>::Identity();
        CHECK(error<S>(half_turn) < S(8) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("strained states: near enough for Newton's method", S, float, double) {
    RandomGenerator random(2);
    for (const StateClass state_class : {StateClass::small_strain, StateClass::large_stretch}) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 50; ++repeat) {
            CHECK(error<S>(random_state<S>(state_class, random)) < S(0.1));
        }
    }
}

TEST_CASE_TEMPLATE("what has no rotation gives what is not finite", S, float, double) {
    CHECK(!rotation_start<S>(Matrix3<S>::Zero()).allFinite());
    CHECK(!rotation_start<S>(Matrix3<S>::Constant(std::numeric_limits<S>::infinity())).allFinite());
}
