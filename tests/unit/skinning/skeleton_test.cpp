// SPDX-License-Identifier: MIT
#include <softtissue/skinning/skeleton.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

template <class S>
Skeleton<S> arm() {
    return {{"shoulder", "elbow", "wrist"}, KinematicTree({-1, 0, 1}), Matrix3X<S>::Zero(3, 3)};
}

}  // namespace

TEST_CASE_TEMPLATE("joints are found by name", S, float, double) {
    const Skeleton<S> skeleton = arm<S>();
    CHECK_NOTHROW(skeleton.validate("arm"));
    CHECK(skeleton.num_joints() == 3);
    CHECK(skeleton.joint("wrist") == 2);
    CHECK(skeleton.has_joint("elbow"));
    CHECK(!skeleton.has_joint("Elbow"));
    CHECK(refusal([&] { static_cast<void>(skeleton.joint("hand")); }) ==
          "skeleton: no joint 'hand'; it has shoulder, elbow, wrist");
}

TEST_CASE("what does not fit together is refused") {
    const auto refused_with = [](const auto& change) {
        Skeleton<double> skeleton = arm<double>();
        change(skeleton);
        return refusal([&] { skeleton.validate("arm"); });
    };
    CHECK(refused_with([](auto& s) { s.joint_names.pop_back(); }) == "arm: 2 joint names, expected 3");
    CHECK(refused_with([](auto& s) { s.joints.setZero(3, 4); }) == "arm: 4 rest joints, expected 3");
    CHECK(refused_with([](auto& s) { s.joint_names[2] = "elbow"; }) == "arm: joint name 'elbow' appears twice");
    CHECK(refused_with([](auto& s) { s.joints(1, 2) = std::numeric_limits<double>::quiet_NaN(); }) ==
          "arm: rest position of joint 2 (wrist) is not finite");
}
