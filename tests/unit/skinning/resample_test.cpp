// SPDX-License-Identifier: MIT
#include <softtissue/skinning/resample.hpp>

#include "arm_body.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <numbers>

using namespace softtissue;
using softtissue_test::random_pose;

namespace {

/// One joint that turns about x by angle(t), moving along x by the same figure; rotation vectors principal.
template <class S, class Angle>
Motion<S> turning(S rate, Index frames, const Angle& angle) {
    Motion<S> motion;
    motion.frame_rate = rate;
    for (Index k = 0; k < frames; ++k) {
        const S a = S(angle(double(k) / double(rate)));
        Pose<S> pose = Pose<S>::rest(1);
        pose.rotation_vectors.col(0) =
            rotation_vector_from_quaternion(quaternion_from_rotation_vector(Vector3<S>(a, 0, 0)));
        pose.translation(0) = a;
        motion.poses.push_back(pose);
    }
    return motion;
}

/// Angle between the rotations of a joint and of a rotation vector.
template <class S>
S angle_between(const Pose<S>& pose, const Vector3<S>& r) {
    const Matrix3<S> A = rotation_matrix_from_rotation_vector<S>(pose.rotation_vectors.col(0));
    const Matrix3<S> difference = A.transpose() * rotation_matrix_from_rotation_vector(r);
    return rotation_vector_from_rotation_matrix(difference).norm();
}

}  // namespace

TEST_CASE_TEMPLATE("the given frames come back, turns beyond pi included", S, float, double) {
    Motion<S> motion;
    motion.frame_rate = S(30);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        motion.poses.push_back(random_pose<S>(4, seed, 7));
    }
    const Motion<S> finer = resample(motion, S(120));
    CHECK(finer.frame_rate == S(120));
    REQUIRE(finer.num_frames() == 45);
    CHECK_NOTHROW(finer.validate("finer", 4));
    const S tolerance = 40 * std::numeric_limits<S>::epsilon();
    for (Index t = 0; t < 12; ++t) {
        const Pose<S>& given = motion.poses[size_t(t)];
        const Pose<S>& met = finer.poses[size_t(4 * t)];
        CHECK(met.translation == given.translation);
        for (Index j = 0; j < 4; ++j) {
            const Matrix3<S> A = rotation_matrix_from_rotation_vector<S>(given.rotation_vectors.col(j));
            const Matrix3<S> B = rotation_matrix_from_rotation_vector<S>(met.rotation_vectors.col(j));
            CHECK((A - B).norm() <= tolerance);
            CHECK(met.rotation_vectors.col(j).norm() <= std::numbers::pi_v<S> * (1 + tolerance));
        }
    }
    const Motion<S> same = resample(motion, S(30));
    CHECK(same.num_frames() == 12);
    CHECK(same.poses[7].translation == motion.poses[7].translation);
}

TEST_CASE_TEMPLATE("rates that are no multiples: frames at k / rate up to the end", S, float, double) {
    const auto line = [](double t) { return 0.5 * t; };
    const Motion<S> motion = turning<S>(S(25), 26, line);  // one second
    for (const S rate : {S(60), S(24), S(7), S(29.97), S(120)}) {
        const Motion<S> other = resample(motion, rate);
        CHECK(other.num_frames() == Index(std::floor(rate)) + 1);
        for (Index k = 0; k < other.num_frames(); ++k) {
            CHECK(std::abs(other.poses[size_t(k)].translation(0) - S(0.5) * S(k) / rate) <=
                  20 * std::numeric_limits<S>::epsilon());
        }
    }
}

TEST_CASE_TEMPLATE("a steady turn through pi and on stays steady", S, float, double) {
    const double speed = 9;  // 0.3 rad a frame
    const Motion<S> motion = turning<S>(S(30), 43, [speed](double t) { return speed * t; });
    const Motion<S> finer = resample(motion, S(120));
    for (Index k = 0; k < finer.num_frames(); ++k) {
        const S angle = S(speed) * S(k) / S(120);
        // spline of (cos a/2, sin a/2): 5/384 (0.15)^4 = 7e-6 inside, some ten times more near the ends
        CHECK(angle_between(finer.poses[size_t(k)], Vector3<S>(angle, 0, 0)) <= S(1.5e-4));
    }
}

TEST_CASE_TEMPLATE("a motion that stands still stands still; single frames and pairs work", S, float, double) {
    const Pose<S> pose = random_pose<S>(3, 5, 3);
    for (const size_t frames : {1U, 2U, 3U, 4U, 9U}) {
        const Motion<S> motion{std::vector<Pose<S>>(frames, pose), S(30)};
        const Motion<S> other = resample(motion, S(77));
        CHECK(other.num_frames() == Index(std::floor(double(frames - 1) * 77 / 30)) + 1);
        for (const Pose<S>& p : other.poses) {
            CHECK((p.rotation_vectors - pose.rotation_vectors).norm() <= 40 * std::numeric_limits<S>::epsilon());
            CHECK((p.translation - pose.translation).norm() <= 4 * std::numeric_limits<S>::epsilon());
        }
    }
}

TEST_CASE("twice continuously differentiable: changes of acceleration vanish with the step") {
    Motion<double> motion;
    motion.frame_rate = 30;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        motion.poses.push_back(random_pose<double>(1, seed, 1));
    }
    // Largest change, between neighbouring frames, of the n-th derivative of a point on the joint.
    const auto largest_change = [&](double rate, int order) {
        std::vector<Vector3<double>> values;
        for (const Pose<double>& pose : resample(motion, rate).poses) {
            values.push_back(rotation_matrix_from_rotation_vector<double>(pose.rotation_vectors.col(0)) *
                                 Vector3<double>(1, 1, 1) +
                             pose.translation);
        }
        for (int d = 0; d < order; ++d) {
            for (size_t k = 0; k + 1 < values.size(); ++k) {
                values[k] = (values[k + 1] - values[k]) * rate;
            }
            values.pop_back();
        }
        double change = 0;
        for (size_t k = 0; k + 1 < values.size(); ++k) {
            change = std::max(change, (values[k + 1] - values[k]).norm());
        }
        return change;
    };
    // velocity and acceleration: halves with the step (C1 and C2); third derivative: jumps and keeps its size
    const std::array<double, 4> orders{1, 1, 1, 0};
    for (int order = 0; order < 4; ++order) {
        const double rate = std::log2(largest_change(30 * 64, order) / largest_change(30 * 128, order));
        CAPTURE(order);
        CHECK(rate == doctest::Approx(orders[size_t(order)]).epsilon(0.1));
    }
}

TEST_CASE("error of a smooth motion falls with the fourth power of the frame time, ends included") {
    const auto angle = [](double t) { return 2 * std::sin(3 * t); };
    const auto error = [&](double rate) {
        const Motion<double> finer = resample(turning<double>(rate, Index(rate) + 1, angle), rate * 8);
        double worst = 0;
        for (Index k = 0; k < finer.num_frames(); ++k) {
            const Vector3<double> exact(angle(double(k) / finer.frame_rate), 0, 0);
            worst = std::max(worst, angle_between(finer.poses[size_t(k)], exact));
        }
        return worst;
    };
    CHECK(std::log2(error(30) / error(60)) >= 3.8);
}

TEST_CASE("a spline of unrolled quaternions is longer than 0.3, however wild the frames") {
    // Neighbours a, b have a.b >= 0: |w_a a + w_b b| >= sqrt(w_a^2 + w_b^2); the others take at most sum |w|.
    double shortest = 1;
    for (Index knots = 2; knots <= 12; ++knots) {
        const UniformCubicSpline<double> cardinal(MatrixX<double>::Identity(knots, knots));
        for (Index i = 0; i + 1 < knots; ++i) {
            for (double s = 0.025; s < 1; s += 0.025) {
                const VectorX<double> w = cardinal(double(i) + s);
                CHECK(std::min(w(i), w(i + 1)) >= 0);
                const double far = w.cwiseAbs().sum() - w(i) - w(i + 1);
                shortest = std::min(shortest, std::hypot(w(i), w(i + 1)) - far);
            }
        }
    }
    CHECK(shortest > 0.3);
}

TEST_CASE("what cannot be resampled is refused") {
    const auto line = [](double t) { return t; };
    Motion<double> motion = turning<double>(30, 3, line);
    CHECK_THROWS_WITH_AS(resample(motion, 0), "resample: new frame rate is 0, expected > 0", InvalidInput);
    CHECK_THROWS_WITH_AS(resample(motion, std::numeric_limits<double>::quiet_NaN()),
                         "resample: new frame rate is nan, expected > 0", InvalidInput);
    CHECK_THROWS_WITH_AS(resample(Motion<double>{{}, 30}, 60), "resample: the motion has no frames", InvalidInput);
    // more frames than can be numbered, and a rate so low that the time between frames is infinite
    CHECK_THROWS_WITH_AS(
        resample(motion, 1e100),
        "resample: frame rate from 30 to 1e+100 gives 6.666666667e+98 frames, expected at most 2147483647",
        InvalidInput);
    const Motion<double> first = resample(motion, std::numeric_limits<double>::denorm_min());
    REQUIRE(first.num_frames() == 1);
    CHECK((first.poses[0].rotation_vectors - motion.poses[0].rotation_vectors).norm() < 1e-15);
    Motion<double> far = motion;
    far.poses[1].translation(0) = std::numeric_limits<double>::max();
    CHECK_THROWS_WITH_AS(resample(far, 60),
                         "resample: translations at new frame 0 are too large for the range of the numbers",
                         InvalidInput);
    motion.poses[1].rotation_vectors(0, 0) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(resample(motion, 60), "resample: frame 1, joint 0: rotation is not finite", InvalidInput);
}
