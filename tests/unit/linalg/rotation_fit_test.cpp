// SPDX-License-Identifier: MIT
#include <softtissue/linalg/rotation_fit.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("one rotation per matrix, for every executor, in place too", S, float, double) {
    RandomGenerator random(5);
    const Index n = 200;
    Matrix3X<S> F(3, 3 * n);
    for (Index c = 0; c < n; ++c) {
        F.template middleCols<3>(3 * c) = random_normal<Matrix3<S>>(random);
    }
    Matrix3X<S> R, R_threads;
    fit_rotations_into(F, R);
    fit_rotations_into(F, R_threads, ThreadExecutor(3));
    CHECK(R == R_threads);
    for (Index c = 0; c < n; ++c) {
        const Matrix3<S> rotation = R.template middleCols<3>(3 * c);
        CHECK(rotation == polar_rotation(Matrix3<S>(F.template middleCols<3>(3 * c))));
        CHECK(rotation.determinant() == doctest::Approx(1).epsilon(1e-5));
        // no turn by a small angle brings it nearer
        const S distance = (F.template middleCols<3>(3 * c) - rotation).squaredNorm();
        for (int axis = 0; axis < 6; ++axis) {
            const Matrix3<S> turned =
                rotation_matrix_from_rotation_vector<S>(S(axis < 3 ? 0.05 : -0.05) * Vector3<S>::Unit(axis % 3)) * rotation;
            CHECK((F.template middleCols<3>(3 * c) - turned).squaredNorm() >= distance * (S(1) - S(1e-5)));
        }
    }
    fit_rotations_into(F, F);
    CHECK(F == R);
}

TEST_CASE("a number of columns that is no multiple of three is refused") {
    Matrix3X<double> F = Matrix3X<double>::Zero(3, 4), R;
    CHECK_THROWS_WITH_AS(fit_rotations_into(F, R), "rotation fit: 4 columns, expected three per matrix", InvalidInput);
}
