// SPDX-License-Identifier: MIT
/// @file
/// From what a person does (where pelvis and feet are, how trunk and arms turn) to a pose of the procedural human.
///
/// What        HumanStance: intentions in body terms. HumanPoser: joint rotations, legs by inverse kinematics.
/// Equation    knee: |a + R_x(k) b| = |ankle - hip|, a and b the rest thigh and shank, solved for k in closed form;
///             hip: the smallest rotation that turns a + R_x(k) b towards the ankle; ankle: what makes the foot stand.
/// Shapes      angles in radians; displacements in metres from the rest pose. Left limbs first.
/// Valid       ankles within reach: a target beyond a straight leg is approached, not reached.
/// Tests       tests/unit/model/human_poser_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/skinning/pose.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace softtissue {

/// Angles about x (lean forwards), y (turn to the left) and z (tip to the right), applied as R_y R_x R_z.
struct HumanStance {
    /// Angles [rad] of one arm.
    struct Arm {
        double lower = 0.0;  // from the rest pose down towards the flank
        double swing = 0.0;  // forwards
        double elbow = 0.0;  // bend
    };
    /// Place and angles [rad] of one foot.
    struct Foot {
        Vector3<double> ball = Vector3<double>::Zero();  // displacement of the ball of the foot
        double pitch = 0.0;                              // heel up
        double toes = 0.0;                               // toes bent up against the foot
    };

    Vector3<double> root = Vector3<double>::Zero();  // displacement of the pelvis joint
    Vector3<double> pelvis = Vector3<double>::Zero();
    Vector3<double> spine = Vector3<double>::Zero();  // for each of the three spine joints
    Vector3<double> neck = Vector3<double>::Zero();   // for neck and head each
    std::array<Arm, 2> arms;
    std::array<Foot, 2> feet;
};

class HumanPoser {
public:
    explicit HumanPoser(Matrix3X<double> rest_joints) : joints_(std::move(rest_joints)) {}

    Pose<double> operator()(const HumanStance& stance) const {
        using namespace human_joint;
        Pose<double> pose = Pose<double>::rest(joints_.cols());
        pose.translation = stance.root;
        const auto set = [&pose](Index joint, const Matrix3<double>& R) {
            pose.rotation_vectors.col(joint) = rotation_vector(R);
        };
        set(pelvis, turned(stance.pelvis));
        for (const Index joint : {spine1, spine2, spine3}) {
            set(joint, turned(stance.spine));
        }
        set(neck, turned(stance.neck));
        set(head, turned(stance.neck));
        for (Index side = 0; side < 2; ++side) {
            const HumanStance::Arm& arm = stance.arms[size_t(side)];
            const double sign = side == 0 ? 1.0 : -1.0;
            const auto lowered = [&](double share) {
                return Matrix3<double>(about_x(-share * arm.swing) * about_z(-sign * share * arm.lower));
            };
            set(collar + side, lowered(collar_share));
            set(shoulder + side, lowered(1.0 - collar_share));
            const Vector3<double> upper = joints_.col(elbow) - joints_.col(shoulder);
            const Vector3<double> hinge = upper.cross(Vector3<double>::UnitZ()).normalized();
            pose.rotation_vectors.col(elbow + side) = arm.elbow * Vector3<double>(hinge(0), sign * hinge(1), 0.0);
            leg(pose, stance, side);
        }
        return pose;
    }

    /// Distance from hip to ankle as a part of the longest possible one; above 1 the foot is out of reach.
    double reach(const HumanStance& stance, Index side) const {
        const auto [a, b] = thigh_and_shank(side);
        return ankle_from_hip(stance, side).norm() / std::sqrt(longest_squared(a, b));
    }

private:
    static constexpr double collar_share = 0.2;  // of a movement of the arm

    static Matrix3<double> about_x(double angle) {
        return Eigen::AngleAxisd(angle, Vector3<double>::UnitX()).toRotationMatrix();
    }
    static Matrix3<double> about_z(double angle) {
        return Eigen::AngleAxisd(angle, Vector3<double>::UnitZ()).toRotationMatrix();
    }
    static Matrix3<double> turned(const Vector3<double>& angles) {
        return Eigen::AngleAxisd(angles(1), Vector3<double>::UnitY()).toRotationMatrix() * about_x(angles(0)) *
               about_z(angles(2));
    }
    static Vector3<double> rotation_vector(const Matrix3<double>& R) {
        const Eigen::AngleAxisd turn(R);
        return turn.angle() * turn.axis();
    }

    std::pair<Vector3<double>, Vector3<double>> thigh_and_shank(Index side) const {
        using namespace human_joint;
        return {joints_.col(knee + side) - joints_.col(hip + side),
                joints_.col(ankle + side) - joints_.col(knee + side)};
    }

    /// Turning b about x changes the length of a + b between bounds: the upper one, squared.
    static double longest_squared(const Vector3<double>& a, const Vector3<double>& b) {
        return a.squaredNorm() + b.squaredNorm() +
               2.0 * (a(0) * b(0) + std::hypot(a(1), a(2)) * std::hypot(b(1), b(2)));
    }

    /// In the pelvis' frame.
    Vector3<double> ankle_from_hip(const HumanStance& stance, Index side) const {
        using namespace human_joint;
        const HumanStance::Foot& foot_target = stance.feet[size_t(side)];
        const Vector3<double> ball = joints_.col(foot + side) + foot_target.ball;
        const Vector3<double> ankle_target =
            ball + about_x(foot_target.pitch) * (joints_.col(ankle + side) - joints_.col(foot + side));
        const Vector3<double> pelvis_at = joints_.col(pelvis) + stance.root;
        return turned(stance.pelvis).transpose() * (ankle_target - pelvis_at) -
               (joints_.col(hip + side) - joints_.col(pelvis));
    }

    void leg(Pose<double>& pose, const HumanStance& stance, Index side) const {
        using namespace human_joint;
        const Vector3<double> target = ankle_from_hip(stance, side);
        const auto [a, b] = thigh_and_shank(side);
        // a . R_x(k) b = a_x b_x + p cos k + q sin k
        const double p = a(1) * b(1) + a(2) * b(2);
        const double q = a(2) * b(1) - a(1) * b(2);
        const double wanted = 0.5 * (target.squaredNorm() - a.squaredNorm() - b.squaredNorm()) - a(0) * b(0);
        const double bend = std::atan2(q, p) + std::acos(std::clamp(wanted / std::hypot(p, q), -1.0, 1.0));
        const Matrix3<double> knee_turn = about_x(bend);
        const Vector3<double> straight = a + knee_turn * b;
        Quaternion<double> turn;  // the smallest one; towards the opposite each is as small
        turn << straight.norm() * target.norm() + straight.dot(target), straight.cross(target);
        if (turn.norm() < 1e-12 * straight.squaredNorm()) {
            turn << 0.0, straight.unitOrthogonal();
        }
        const Matrix3<double> hip_turn = rotation_matrix_from_quaternion<double>(turn.normalized());
        const HumanStance::Foot& foot_target = stance.feet[size_t(side)];
        const Matrix3<double> above = turned(stance.pelvis) * hip_turn * knee_turn;
        pose.rotation_vectors.col(hip + side) = rotation_vector(hip_turn);
        pose.rotation_vectors.col(knee + side) << bend, 0.0, 0.0;
        pose.rotation_vectors.col(ankle + side) = rotation_vector(above.transpose() * about_x(foot_target.pitch));
        pose.rotation_vectors.col(foot + side) << -foot_target.toes, 0.0, 0.0;
    }

    Matrix3X<double> joints_;
};

}  // namespace softtissue
