// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/body_anatomy.hpp>

#include <softtissue/model/human_solid.hpp>

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <string>

using namespace softtissue;

TEST_CASE("a profile passes through its knots, straight between, constant beyond") {
    const Profile profile{{{-1, 3}, {1, 5}, {2, 5}, {4, 1}}};
    CHECK(profile(-9) == 3);
    CHECK(profile(-1) == 3);
    CHECK(profile(0) == 4);
    CHECK(profile(1) == 5);
    CHECK(profile(1.5) == 5);
    CHECK(profile(3) == 3);
    CHECK(profile(4) == 1);
    CHECK(profile(9) == 1);
}

TEST_CASE("the tables are those of SMPL's tree; left and right are alike") {
    const BodyAnatomy anatomy = smpl_anatomy();
    anatomy.require_tree(KinematicTree(human_parents()));
    CHECK(anatomy.limbs.size() == 10);
    for (size_t k = 0; k < anatomy.limbs.size(); k += 2) {
        const LimbBone& left = anatomy.limbs[k];
        const LimbBone& right = anatomy.limbs[k + 1];
        CHECK(right.start == left.start + 1);
        CHECK(right.end == left.end + 1);
        CHECK(right.radius.knots == left.radius.knots);
        CHECK(anatomy.parents[size_t(left.end)] == left.start);
        CHECK(anatomy.parents[size_t(right.end)] == right.start);
    }
    for (const LimbBone& bone : anatomy.limbs) {
        CHECK(bone.cap < 1);
        for (const auto& [t, radius] : bone.radius.knots) {
            CHECK(radius > 0.01);
            CHECK(radius < 0.04);
        }
    }
}

TEST_CASE_TEMPLATE("the scale is the size of the skeleton", S, float, double) {
    const BodyAnatomy anatomy = smpl_anatomy();
    const Matrix3X<S> joints = human_rest_joints().cast<S>();
    const S scale = anatomy.scale(joints);
    CHECK(scale > S(0.9));
    CHECK(scale < S(1.1));
    CHECK(anatomy.scale<S>(S(2) * joints) == doctest::Approx(double(S(2) * scale)));
}

TEST_CASE("other skeletons and incomplete tables are refused") {
    BodyAnatomy anatomy = smpl_anatomy();
    const auto message = [&](const KinematicTree& tree) {
        try {
            anatomy.require_tree(tree);
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    std::vector<std::int32_t> parents = human_parents();
    const std::string tables = " as in the tables of the anatomy (SMPL's order by default)";
    CHECK(message(KinematicTree({-1, 0})) == "layered body: the skeleton has 2 joints, expected 24" + tables);
    parents[5] = 1;
    CHECK(message(KinematicTree(parents)) == "layered body: joint 5 hangs from joint 1, expected 2" + tables);
    parents[5] = 2;
    SUBCASE("bone") {
        anatomy.limbs.pop_back();
        CHECK(message(KinematicTree(parents)) ==
              "anatomy: no bone for the skin of joint 19, expected a limb or the trunk");
    }
    SUBCASE("joint") {
        anatomy.trunk.joints.push_back(24);
        CHECK(message(KinematicTree(parents)) == "anatomy: joint 24, expected 0 to 23");
    }
    SUBCASE("fat") {
        anatomy.fat.pop_back();
        CHECK(message(KinematicTree(parents)) ==
              "anatomy: 23 values of fat and 24 of depth, expected one for each of the 24 joints");
    }
}
