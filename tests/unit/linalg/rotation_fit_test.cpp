// SPDX-License-Identifier: MIT
#include <softtissue/linalg/rotation_fit.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

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
        // as one by one, but for the order of sums
        const Matrix3<S> alone = polar_rotation(svd3(Matrix3<S>(F.template middleCols<3>(3 * c))));
        CHECK((rotation - alone).norm() < S(300) * std::numeric_limits<S>::epsilon());
        CHECK(rotation.determinant() == doctest::Approx(1).epsilon(1e-5));
        // no turn by a small angle brings it nearer
        const S distance = (F.template middleCols<3>(3 * c) - rotation).squaredNorm();
        for (int axis = 0; axis < 6; ++axis) {
            const Matrix3<S> turned =
                rotation_matrix_from_rotation_vector<S>(S(axis < 3 ? 0.05 : -0.05) * Vector3<S>::Unit(axis % 3)) *
                rotation;
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

TEST_CASE_TEMPLATE("warm starts, near, far and impossible, end at the same rotations", S, float, double) {
    RandomGenerator random(6);
    const Index n = 211;  // no multiple of a pack
    Matrix3X<S> F(3, 3 * n), R, cold, threads;
    Quaternions<S> start(n, 4);
    for (Index c = 0; c < n; ++c) {
        const Matrix3<S> state = random_state<S>(all_state_classes[size_t(c) % all_state_classes.size()], random);
        F.template middleCols<3>(3 * c) = state;
        const Vector3<S> turn = S(c % 3 == 0 ? 2.5 : 0.05) * random_unit<Vector3<S>>(random);
        start.row(c) = quaternion_from_rotation_matrix<S>(rotation_matrix_from_rotation_vector<S>(turn) *
                                                          polar_rotation(svd3(state)));
    }
    start.row(17).setZero();
    start.row(18).setConstant(std::numeric_limits<S>::quiet_NaN());
    fit_rotations_into(F, cold);
    Quaternions<S> q = start, q_threads = start;
    fit_rotations_into(F, q, R);
    fit_rotations_into(F, q_threads, threads, ThreadExecutor(3));
    CHECK(q == q_threads);
    CHECK(R == threads);
    for (Index c = 0; c < n; ++c) {
        const Matrix3<S> rotation = R.template middleCols<3>(3 * c);
        // A rotation is known to epsilon |F| / (s_1 + s_2), which these states keep below 100 epsilon.
        CHECK((rotation - cold.template middleCols<3>(3 * c)).norm() < S(300) * std::numeric_limits<S>::epsilon());
        CHECK((rotation_matrix_from_quaternion<S>(q.row(c).transpose()) - rotation).norm() <
              S(8) * std::numeric_limits<S>::epsilon());
    }
    // a fit from its own result stands still, to rounding
    Matrix3X<S> again;
    fit_rotations_into(F, q, again);
    CHECK((again - R).cwiseAbs().maxCoeff() < S(300) * std::numeric_limits<S>::epsilon());
    // and the lanes do not know each other
    for (const Index c : {Index(0), Index(17), Index(100), n - 1}) {
        const Matrix3X<S> one_F = F.template middleCols<3>(3 * c);
        Quaternions<S> one_q = start.middleRows(c, 1);
        Matrix3X<S> one_R;
        fit_rotations_into(one_F, one_q, one_R);
        CHECK(one_R == R.template middleCols<3>(3 * c));
    }
}

TEST_CASE("warm starts of another number are refused") {
    const Matrix3X<double> F = Matrix3X<double>::Zero(3, 6);
    Matrix3X<double> R;
    Quaternions<double> q(3, 4);
    CHECK_THROWS_WITH_AS(fit_rotations_into(F, q, R), "rotation fit: 3 quaternions, expected 2", InvalidInput);
}

TEST_CASE_TEMPLATE("equal, vanishing, reflected, subnormal and huge stretches: no farther than the plain fit", S, float,
                   double) {
    using Limits = std::numeric_limits<S>;
    const S epsilon = Limits::epsilon();
    RandomGenerator random(7);
    std::vector<Matrix3<S>> states;
    const auto add = [&](S a, S b, S c, S scale) {
        const Matrix3<S> U = random_rotation<S>(random), V = random_rotation<S>(random);
        states.push_back(scale * (U * Vector3<S>(a, b, c).asDiagonal() * V.transpose()));
    };
    for (int repeat = 0; repeat < 4; ++repeat) {
        for (const S scale : {S(1), Limits::min(), S(64) * Limits::denorm_min(), S(1e-20), S(1e30)}) {
            for (const S last : {S(2), S(1), epsilon, S(0), -epsilon, S(-1), S(-2)}) {
                add(S(2), S(2), last, scale);
                add(S(3), S(1), last < S(-1) || last > S(1) ? S(0) : last, scale);
            }
            add(S(1), S(0), S(0), scale);
        }
        add(S(0), S(0), S(0), S(1));
    }
    const Index n = Index(states.size());
    Matrix3X<S> F(3, 3 * n), R;
    Quaternions<S> q(n, 4);
    for (Index c = 0; c < n; ++c) {
        F.template middleCols<3>(3 * c) = states[size_t(c)];
        const Vector3<S> turn = S(0.05) * random_unit<Vector3<S>>(random);
        q.row(c) = quaternion_from_rotation_matrix<S>(rotation_matrix_from_rotation_vector<S>(turn) *
                                                      polar_rotation(svd3(states[size_t(c)])));
    }
    const auto check = [&](Index c) {
        const Matrix3<S> rotation = R.template middleCols<3>(3 * c);
        CHECK(is_rotation(rotation, S(16) * epsilon));
        // |F - R|^2 = |F|^2 + 3 - 2 tr(R^T F): of tiny and huge matrices the trace alone says how near they are
        const Matrix3<S> scaled =
            states[size_t(c)] / std::max(states[size_t(c)].cwiseAbs().maxCoeff(), Limits::denorm_min());
        const S fitted = rotation.cwiseProduct(scaled).sum();
        CHECK(fitted >= polar_rotation(svd3(scaled)).cwiseProduct(scaled).sum() - S(32) * epsilon);
    };
    fit_rotations_into(F, R);
    for (Index c = 0; c < n; ++c) {
        check(c);
    }
    for (int repeat = 0; repeat < 2; ++repeat) {  // from two degrees, then from its own result
        fit_rotations_into(F, q, R);
        for (Index c = 0; c < n; ++c) {
            check(c);
        }
    }
    F(1, 7) = Limits::quiet_NaN();
    fit_rotations_into(F, q, R);
    CHECK(!R.template middleCols<3>(6).allFinite());
    F.template middleCols<3>(6).setIdentity();
    fit_rotations_into(F, q, R);
    CHECK((R.template middleCols<3>(6) - Matrix3<S>::Identity()).norm() < S(8) * epsilon);
    CHECK(R.allFinite());
}
