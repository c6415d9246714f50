// SPDX-License-Identifier: MIT
#include <softtissue/skinning/inverse_kinematics.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

/// A trunk with two arms: joints 0 - 1 - 2 - 3 and 1 - 4 - 5 - 6, numbered so that a parent may come after its child.
template <class S>
struct Body {
    KinematicTree tree{{KinematicTree::no_parent, 0, 6, 2, 1, 4, 1}};
    Matrix3X<S> joints =
        (Matrix3X<double>(3, 7) << 0, 0, -1, -2, 1, 2, -0.5, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0.2, 0, 0.2, 0.1)
            .finished()
            .template cast<S>();
};

template <class S>
Pose<S> random_pose(RandomGenerator& random, double angle) {
    Pose<S> pose = Pose<S>::rest(7);
    for (S& entry : pose.rotation_vectors.reshaped()) {
        entry = S(angle * random.normal());
    }
    for (S& entry : pose.translation) {
        entry = S(random.normal());
    }
    return pose;
}

/// Goals that the pose meets.
template <class S>
PoseGoals<S> goals_of(const Body<S>& body, const Pose<S>& pose, S weight = S(1)) {
    const auto transforms = joint_transforms(body.tree, body.joints, pose);
    const Matrix3X<S> x = posed_joints(transforms, body.joints);
    PoseGoals<S> goals;
    goals.positions = {{3, x.col(3), weight}, {5, x.col(5), S(2)}, {0, x.col(0), S(1)}};
    goals.orientations = {{5, transforms[5].linear, S(0.3)}};
    return goals;
}

}  // namespace

TEST_CASE("the Jacobian is the derivative of the residual, with mobilities and without the root") {
    RandomGenerator random(3);
    const Body<double> body;
    InverseKinematicsOptions<double> options;
    options.mobility = VectorX<double>::Constant(7, 1.0);
    options.mobility(1) = 0.3;
    options.mobility(2) = 0.0;
    for (const bool root_translates : {true, false}) {
        options.root_translates = root_translates;
        const InverseKinematics<double> solver(body.tree, body.joints, options);
        const Pose<double> pose = random_pose<double>(random, 0.6);
        const PoseGoals<double> goals = goals_of(body, random_pose<double>(random, 0.6), 0.7);
        const MatrixX<double> J = solver.jacobian(goals, pose);
        CHECK(J.rows() == 18);
        CHECK(J.cols() == 24);
        CHECK(J.middleCols(6, 3).isZero(0));
        for (int trial = 0; trial < 4; ++trial) {
            VectorX<double> step(24);
            for (double& entry : step) {
                entry = random.normal();
            }
            const auto residual = [&](double h) { return solver.residual(goals, solver.moved(pose, h * step)); };
            CHECK(taylor_rate(residual, (J * step).eval()).is_at_least(2));
        }
    }
}

TEST_CASE_TEMPLATE("goals in reach are met", S, float, double) {
    RandomGenerator random(5);
    const Body<S> body;
    const InverseKinematics<S> solver(body.tree, body.joints);
    for (int trial = 0; trial < 10; ++trial) {
        CAPTURE(trial);
        Pose<S> pose = random_pose<S>(random, 0.2);
        const PoseGoals<S> goals = goals_of(body, random_pose<S>(random, 0.5));
        const InverseKinematicsReport<S> report = solver.solve_into(goals, pose);
        CHECK(report.status == InverseKinematicsStatus::converged);
        CHECK(report.iterations < 50);
        CHECK(report.residual < (std::is_same_v<S, double> ? S(1e-7) : S(1e-4)));
        CHECK(solver.residual(goals, pose).norm() == report.residual);
    }
}

TEST_CASE_TEMPLATE("a pose that meets its goals is not touched", S, float, double) {
    RandomGenerator random(6);
    const Body<S> body;
    const Pose<S> met = random_pose<S>(random, 0.5);
    Pose<S> pose = met;
    const auto report = InverseKinematics<S>(body.tree, body.joints).solve_into(goals_of(body, met), pose);
    CHECK(report.status == InverseKinematicsStatus::converged);
    CHECK(report.iterations == 0);
    CHECK(pose.rotation_vectors == met.rotation_vectors);
    CHECK(pose.translation == met.translation);
}

TEST_CASE("a target out of reach is approached along the straight arm, at the length of the arm") {
    const Body<double> body;
    InverseKinematicsOptions<double> options;
    options.root_translates = false;
    options.mobility = VectorX<double>::Zero(7);
    options.mobility(4) = options.mobility(5) = 1.0;  // shoulder and elbow; joint 5 ends the arm 4 - 5
    const InverseKinematics<double> solver(body.tree, body.joints, options);
    const Vector3<double> shoulder = body.joints.col(4), target(1, 5, 1);
    PoseGoals<double> goals;
    goals.positions = {{5, target}};
    Pose<double> pose = Pose<double>::rest(7);
    const auto report = solver.solve_into(goals, pose);
    CHECK(report.status == InverseKinematicsStatus::converged);
    const double length = (body.joints.col(5) - shoulder).norm();
    CHECK(report.residual == doctest::Approx((target - shoulder).norm() - length).epsilon(1e-9));
    const Matrix3X<double> x = posed_joints(joint_transforms(body.tree, body.joints, pose), body.joints);
    CHECK((x.col(5) - shoulder).normalized().dot((target - shoulder).normalized()) == doctest::Approx(1.0));
    CHECK(pose.rotation_vectors.leftCols(4).isZero(0));  // what cannot help stays
    CHECK(pose.translation.isZero(0));
}

TEST_CASE("joints with more mobility turn more") {
    const Body<double> body;
    PoseGoals<double> goals;
    goals.positions = {{3, body.joints.col(3) + Vector3<double>(0.1, 0.1, 0.05)}};
    InverseKinematicsOptions<double> options;
    options.root_translates = false;
    options.mobility = VectorX<double>::Ones(7);
    std::array<double, 2> turned{};
    for (const bool stiff : {false, true}) {
        options.mobility(2) = stiff ? 0.1 : 1.0;
        Pose<double> pose = Pose<double>::rest(7);
        const auto report = InverseKinematics<double>(body.tree, body.joints, options).solve_into(goals, pose);
        CHECK(report.status == InverseKinematicsStatus::converged);
        turned[std::size_t(stiff)] = pose.rotation_vectors.col(2).norm();
    }
    CHECK(turned[1] < 0.3 * turned[0]);
}

TEST_CASE("an orientation goal turns its joint, half a turn away included, and nothing else need move") {
    const Body<double> body;
    const InverseKinematics<double> solver(body.tree, body.joints);
    for (const double angle : {0.1, 2.0, 3.1}) {
        PoseGoals<double> goals;
        goals.orientations = {{1, rotation_matrix_from_rotation_vector<double>(Vector3<double>(0, angle, 0)), 0.2}};
        Pose<double> pose = Pose<double>::rest(7);
        const auto report = solver.solve_into(goals, pose);
        CHECK(report.status == InverseKinematicsStatus::converged);
        CHECK(report.residual < 1e-7);
        CHECK(pose.rotation_vectors.rightCols(5).isZero(0));
    }
}

TEST_CASE("iterations are limited, without goals there is nothing to do") {
    RandomGenerator random(8);
    const Body<double> body;
    InverseKinematicsOptions<double> options;
    options.max_iterations = 2;
    const InverseKinematics<double> solver(body.tree, body.joints, options);
    Pose<double> pose = Pose<double>::rest(7);
    const PoseGoals<double> goals = goals_of(body, random_pose<double>(random, 1.0));
    const double before = solver.residual(goals, pose).norm();
    const auto report = solver.solve_into(goals, pose);
    CHECK(report.status == InverseKinematicsStatus::max_iterations);
    CHECK(report.iterations == 2);
    CHECK(report.residual < before);
    CHECK(solver.solve_into({}, pose).status == InverseKinematicsStatus::converged);
}

TEST_CASE("what does not fit is refused") {
    const Body<double> body;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    InverseKinematicsOptions<double> options;
    options.mobility = VectorX<double>::Ones(3);
    CHECK(refusal([&] { InverseKinematics<double>(body.tree, body.joints, options); }) ==
          "inverse kinematics: 3 mobilities, expected one for each of 7 joints");
    options.mobility = -VectorX<double>::Ones(7);
    CHECK(refusal([&] { InverseKinematics<double>(body.tree, body.joints, options); }) ==
          "inverse kinematics: mobility of joint 0 is -1, expected >= 0");
    CHECK(refusal([&] { InverseKinematics<double>(body.tree, Matrix3X<double>::Zero(3, 6)); }) ==
          "inverse kinematics: 6 rest joints, expected 7 with finite positions");
    const InverseKinematics<double> solver(body.tree, body.joints);
    const auto refused = [&](const PoseGoals<double>& goals, Index joints = 7) {
        Pose<double> pose = Pose<double>::rest(joints);
        return refusal([&] { static_cast<void>(solver.solve_into(goals, pose)); });
    };
    CHECK(refused({{{7, Vector3<double>::Zero(), 1.0}}, {}}) ==
          "inverse kinematics: position goal 0 for joint 7, expected a joint from 0 to 6 and finite values");
    CHECK(!refused({{{1, Vector3<double>::Constant(nan), 1.0}}, {}}).empty());
    CHECK(!refused({{}, {{1, Matrix3<double>::Constant(nan), 1.0}}}).empty());
    CHECK(!refused({}, 5).empty());
}

TEST_CASE_TEMPLATE("poses that are not finite are refused, numbers out of range are told, and nothing runs without end",
                   S, float, double) {
    using Limits = std::numeric_limits<S>;
    const Body<S> body;
    const Pose<S> rest = Pose<S>::rest(7);
    const PoseGoals<S> goals{{{3, Vector3<S>(S(1), S(2), S(3)), S(1)}}, {}};
    Pose<S> pose = rest;
    pose.rotation_vectors(1, 2) = Limits::quiet_NaN();
    const InverseKinematics<S> solver(body.tree, body.joints);
    CHECK(refusal([&] { static_cast<void>(solver.solve_into(goals, pose)); }) ==
          "joint_transforms: joint 2: rotation is not finite");

    pose = rest;
    PoseGoals<S> far = goals;
    far.positions[0].position(0) = Limits::max();
    CHECK(solver.solve_into(far, pose).status == InverseKinematicsStatus::not_finite);
    CHECK(pose.rotation_vectors.isZero(S(0)));
    far = goals;
    far.positions[0].weight = std::sqrt(Limits::max());
    CHECK(solver.solve_into(far, pose).status == InverseKinematicsStatus::not_finite);
    CHECK(pose.rotation_vectors.isZero(S(0)));

    // a Jacobian whose squares are just within the range of the numbers
    for (const S size : {std::sqrt(Limits::max()) / S(64), std::sqrt(Limits::max()) / S(8)}) {
        InverseKinematicsOptions<S> wild;
        wild.mobility = VectorX<S>::Constant(7, size);
        pose = rest;
        CHECK(InverseKinematics<S>(body.tree, body.joints, wild).solve_into(goals, pose).status !=
              InverseKinematicsStatus::converged);
        CHECK(pose.rotation_vectors.allFinite());
    }
    pose = rest;

    // joints that hardly turn: the squares of the Jacobian are zero
    InverseKinematicsOptions<S> options;
    options.mobility = VectorX<S>::Constant(7, Limits::min());
    options.root_translates = false;
    const InverseKinematics<S> stiff(body.tree, body.joints, options);
    CHECK(stiff.solve_into(goals, pose).status == InverseKinematicsStatus::stalled);
    CHECK(pose.rotation_vectors.allFinite());
}
