// SPDX-License-Identifier: MIT
#include <softtissue/model/human_solid.hpp>

#include <softtissue/skinning/kinematic_tree.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

using namespace softtissue;

TEST_CASE("human joints: SMPL's tree and names, mirrored in pairs, inside the body") {
    const Matrix3X<double> J = human_rest_joints();
    const HumanSolid solid;
    REQUIRE(J.cols() == 24);
    CHECK(KinematicTree(human_parents()).num_joints() == 24);
    CHECK(human_joint_names().size() == 24);
    CHECK(human_joint_names()[size_t(human_joint::elbow)] == "left_elbow");
    for (Index j = 0; j < J.cols(); ++j) {
        CHECK(mirror_joint(mirror_joint(j)) == j);
        CHECK(mirrored(J.col(j)) == J.col(mirror_joint(j)));
        CHECK(solid(J.col(j)) < 0.0);
        CHECK(human_parents()[size_t(mirror_joint(j))] ==
              (j == 0 ? -1 : std::int32_t(mirror_joint(human_parents()[size_t(j)]))));
    }
    CHECK(J(0, human_joint::shoulder) > 0.0);  // left is +x
}

TEST_CASE("HumanSolid: symmetric, outside in the gaps a body has, soles on the floor") {
    const HumanSolid solid;
    CHECK(solid({0.0, 1.0, 0.0}) < 0.0);
    CHECK(solid({0.0, 0.6, 0.0}) > 0.02);   // between the legs
    CHECK(solid({0.26, 1.1, 0.0}) > 0.02);  // between arm and flank
    CHECK(solid({0.0, 1.6, 0.3}) > 0.05);
    CHECK(solid({0.14, -0.004, 0.05}) > 0.0);
    CHECK(solid({0.14, 0.004, 0.05}) < 0.0);
    for (int i = 0; i < 200; ++i) {
        const double a = 0.37 * i;
        const Vector3<double> x(0.5 * std::sin(a), 0.9 + 0.9 * std::cos(1.7 * a), 0.15 * std::sin(2.3 * a));
        CHECK(solid(x) == solid(mirrored(x)));
    }
}

TEST_CASE("HumanSolid: a distance of about unit slope near the surface") {
    const HumanSolid solid;
    for (const Vector3<double>& x : {Vector3<double>(0.0, 1.1, 0.1), Vector3<double>(0.11, 0.3, -0.07),
                                     Vector3<double>(0.33, 1.27, 0.0), Vector3<double>(0.0, 1.73, 0.0)}) {
        const DistanceSample s = sample_distance(solid, x);
        CHECK(std::abs(s.value) < 0.05);
        CHECK(s.gradient.norm() > 0.6);
        CHECK(s.gradient.norm() < 1.4);
    }
}
