// SPDX-License-Identifier: MIT
#include <softtissue/model/procedural_motion.hpp>

#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

using namespace softtissue;

static_assert(std::is_same_v<decltype(procedural_motion<float>()), Motion<float>>);
static_assert(std::is_same_v<decltype(procedural_walk<double>(60.0)), Motion<double>>);

namespace {

std::vector<Matrix3X<double>> joint_paths(const Motion<double>& motion) {
    const Matrix3X<double> rest = human_rest_joints();
    const KinematicTree tree(human_parents());
    std::vector<Matrix3X<double>> result;
    for (const Pose<double>& pose : motion.poses) {
        const auto T = joint_transforms<double>(tree, rest, pose);
        Matrix3X<double> joints = rest;
        for (Index j = 0; j < rest.cols(); ++j) {
            joints.col(j) = T[size_t(j)](rest.col(j));
        }
        result.push_back(joints);
    }
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("procedural motions: valid, begin and end at rest, last as long as stated", S, float, double) {
    const Motion<S> walk = procedural_walk<S>();
    const Motion<S> jump = procedural_jump<S>();
    const Motion<S> twist = procedural_twist<S>();
    const Motion<S> all = procedural_motion<S>();
    CHECK(double(walk.duration()) == doctest::Approx(2.9).epsilon(0.02));
    CHECK(double(jump.duration()) == doctest::Approx(2.5).epsilon(0.02));
    CHECK(double(twist.duration()) == doctest::Approx(2.3).epsilon(0.02));
    CHECK(double(all.duration()) == doctest::Approx(6.5).epsilon(0.02));
    for (const Motion<S>* motion : {&walk, &jump, &twist, &all}) {
        motion->validate("procedural", 24);
        CHECK(motion->frame_rate == S(120));
        CHECK(motion->poses.front().rotation_vectors.isZero(S(0)));
        CHECK(motion->poses.front().translation.isZero(S(0)));
        // The last frame lies up to 1/120 s before the end: smooth_step(1/120 / 0.3) = 2e-4 of angles below one.
        CHECK(motion->poses.back().rotation_vectors.cwiseAbs().maxCoeff() < S(3e-4));
        CHECK(std::abs(motion->poses.back().translation(1)) < S(1e-5));
    }
}

TEST_CASE("procedural_motion: human speeds and accelerations, within the limits of the joints") {
    const Motion<double> motion = procedural_motion<double>(120.0);
    const auto x = joint_paths(motion);
    double speed = 0.0;
    double acceleration = 0.0;
    double turning = 0.0;
    for (size_t t = 1; t + 1 < x.size(); ++t) {
        const auto& rotations = motion.poses;
        speed = std::max(speed, (x[t + 1] - x[t - 1]).colwise().norm().maxCoeff() * 60.0);
        acceleration = std::max(acceleration, (x[t + 1] - 2.0 * x[t] + x[t - 1]).colwise().norm().maxCoeff() * 14400.0);
        turning = std::max(
            turning,
            (rotations[t + 1].rotation_vectors - rotations[t - 1].rotation_vectors).colwise().norm().maxCoeff() * 60.0);
        for (const Index knee : {human_joint::knee, human_joint::knee + 1}) {
            CHECK(rotations[t].rotation_vectors(0, knee) > -1e-6);
            CHECK(rotations[t].rotation_vectors(0, knee) < 2.2);
        }
        CHECK(rotations[t].rotation_vectors.colwise().norm().maxCoeff() < 2.6);  // far from the cut of the logarithm
    }
    CHECK(speed > 4.0);
    CHECK(speed < 12.0);
    CHECK(acceleration < 200.0);
    CHECK(turning < 16.0);
}

TEST_CASE("procedural_motion: feet stand on the floor but for the jump, and planted feet do not slide") {
    const auto x = joint_paths(procedural_motion<double>(120.0));
    const Matrix3X<double> rest = human_rest_joints();
    int airborne = 0;
    for (size_t t = 1; t < x.size(); ++t) {
        double lowest = 1.0;
        double least_slip = 100.0;  // along the floor
        for (const Index foot : {human_joint::foot, human_joint::foot + 1}) {
            const double height = x[t](1, foot) - rest(1, foot);
            CHECK(height > -0.004);
            lowest = std::min(lowest, height);
            const Vector3<double> step = x[t].col(foot) - x[t - 1].col(foot);
            least_slip = std::min(least_slip, std::hypot(step(0), step(2)) * 120.0);
        }
        airborne += lowest > 0.01 ? 1 : 0;
        if (lowest < 0.004) {
            CHECK(least_slip < 0.05);
        }
    }
    CHECK(airborne > 30);
    CHECK(airborne < 55);
}

TEST_CASE("procedural_motion: the same bits at every call, and at half the rate every other frame") {
    const Motion<double> a = procedural_motion<double>(120.0);
    const Motion<double> b = procedural_motion<double>(120.0);
    const Motion<double> half = procedural_motion<double>(60.0);
    REQUIRE(a.num_frames() == b.num_frames());
    for (size_t t = 0; t < a.poses.size(); ++t) {
        CHECK(a.poses[t].rotation_vectors == b.poses[t].rotation_vectors);
        CHECK(a.poses[t].translation == b.poses[t].translation);
    }
    for (size_t t = 0; t < half.poses.size(); ++t) {
        CHECK(half.poses[t].rotation_vectors.isApprox(a.poses[2 * t].rotation_vectors, 1e-9));
    }
}

TEST_CASE("procedural motions refuse a frame rate that is none") {
    CHECK_THROWS_WITH_AS(procedural_walk<double>(0.0), "procedural motion: frame rate is 0, expected > 0",
                         InvalidInput);
    CHECK_THROWS_AS(procedural_motion<float>(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}
