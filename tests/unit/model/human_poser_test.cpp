// SPDX-License-Identifier: MIT
#include <softtissue/model/human_poser.hpp>

#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace softtissue;

namespace {

struct Posed {
    Matrix3X<double> rest = human_rest_joints();
    HumanPoser poser{rest};

    std::vector<AffineTransform<double>> transforms(const HumanStance& stance) const {
        return joint_transforms<double>(KinematicTree(human_parents()), rest, poser(stance));
    }
    Matrix3X<double> joints(const HumanStance& stance) const {
        const auto T = transforms(stance);
        Matrix3X<double> result = rest;
        for (Index j = 0; j < rest.cols(); ++j) {
            result.col(j) = T[size_t(j)](rest.col(j));
        }
        return result;
    }
};

HumanStance crouching() {
    HumanStance stance;
    stance.root = {0.03, -0.2, -0.05};
    stance.pelvis = {0.3, 0.2, -0.1};
    stance.spine = {0.1, -0.1, 0.05};
    stance.feet[0] = {{0.02, 0.03, 0.15}, 0.4, 0.2};
    stance.feet[1] = {{-0.01, 0.0, -0.1}, -0.1, 0.0};
    return stance;
}

}  // namespace

TEST_CASE("HumanPoser: nothing wanted is the rest pose") {
    const Pose<double> pose = Posed().poser(HumanStance{});
    // The knee's acos loses half the digits near a straight leg: sqrt(1e-16) / sin(5 degrees) at worst.
    CHECK(pose.rotation_vectors.cwiseAbs().maxCoeff() < 1e-6);
    CHECK(pose.translation.isZero(0.0));
}

TEST_CASE("HumanPoser: pelvis and feet are where they should be, feet as turned as they should be") {
    const Posed body;
    const HumanStance stance = crouching();
    const Matrix3X<double> J = body.joints(stance);
    const auto T = body.transforms(stance);
    CHECK((J.col(human_joint::pelvis) - body.rest.col(human_joint::pelvis) - stance.root).norm() < 1e-14);
    for (Index side = 0; side < 2; ++side) {
        CHECK(body.poser.reach(stance, side) < 1.0);
        const auto& foot = stance.feet[size_t(side)];
        CHECK((J.col(human_joint::foot + side) - body.rest.col(human_joint::foot + side) - foot.ball).norm() < 1e-12);
        const Matrix3<double>& R = T[size_t(human_joint::ankle + side)].linear;
        CHECK(std::abs(R(1, 2) + std::sin(foot.pitch)) < 1e-12);  // e_z turned about x
        CHECK(std::abs(R(0, 0) - 1.0) < 1e-12);
        CHECK(body.poser(stance).rotation_vectors(0, human_joint::knee + side) > 0.0);  // knees bend one way
    }
}

TEST_CASE("HumanPoser: out of reach is a straight leg towards the target, and no NaN") {
    const Posed body;
    HumanStance stance;
    stance.root(1) = 0.3;
    CHECK(body.poser.reach(stance, 0) > 1.0);
    const Matrix3X<double> J = body.joints(stance);
    REQUIRE(J.allFinite());
    const Vector3<double> hip = J.col(human_joint::hip);
    const Vector3<double> leg = J.col(human_joint::ankle) - hip;
    const Vector3<double> wanted = body.rest.col(human_joint::ankle) - hip;
    CHECK(leg.cross(wanted).norm() < 1e-9);
    CHECK(leg.norm() * body.poser.reach(stance, 0) == doctest::Approx(wanted.norm()));
}

TEST_CASE("HumanPoser: arms go down, forwards and bend, the same on both sides") {
    const Posed body;
    HumanStance stance;
    for (auto& arm : stance.arms) {
        arm.lower = 0.5;
    }
    const Matrix3X<double> down = body.joints(stance);
    CHECK(down(1, human_joint::wrist) < body.rest(1, human_joint::wrist) - 0.05);
    CHECK(down(0, human_joint::wrist) < body.rest(0, human_joint::wrist) - 0.1);
    for (auto& arm : stance.arms) {
        arm.swing = 0.5;
        arm.elbow = 0.4;
    }
    const Matrix3X<double> forward = body.joints(stance);
    CHECK(forward(2, human_joint::wrist) > down(2, human_joint::wrist) + 0.2);
    for (Index j = 0; j < 24; ++j) {
        CHECK((forward.col(j) - mirrored(forward.col(mirror_joint(j)))).norm() < 1e-6);
    }
}
