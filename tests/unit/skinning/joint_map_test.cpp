// SPDX-License-Identifier: MIT
#include <softtissue/skinning/joint_map.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

/// A chain of joints with these names: what a map asks of a skeleton is names.
Skeleton<double> skeleton_of(const std::vector<std::string>& names) {
    std::vector<std::int32_t> parents(names.size());
    for (size_t j = 0; j < names.size(); ++j) {
        parents[j] = std::int32_t(j) - 1;
    }
    return {names, KinematicTree(parents), Matrix3X<double>::Zero(3, Index(names.size()))};
}

const std::vector<std::string> cmu_names{
    "Hips",      "LHipJoint",   "LeftHip",       "LeftKnee",   "LeftAnkle",    "LeftToe",   "RHipJoint",
    "RightHip",  "RightKnee",   "RightAnkle",    "RightToe",   "lowerback",    "Chest",     "Chest2",
    "lowerneck", "Neck",        "Head",          "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist",
    "lhand",     "RightCollar", "RightShoulder", "RightElbow", "RightWrist",   "rhand"};

}  // namespace

TEST_CASE("every style names each of SMPL's joints once") {
    const Skeleton<double> smpl = skeleton_of(smpl_joint_names());
    CHECK(smpl.num_joints() == 24);
    for (const MotionStyle style : {MotionStyle::cmu, MotionStyle::fair, MotionStyle::makehuman, MotionStyle::smpl}) {
        const JointMap map = smpl_joint_map(style, smpl);
        std::set<std::string> targets, sources;
        for (const JointPair& pair : map.pairs) {
            targets.insert(pair.target);
            sources.insert(pair.source);
        }
        CHECK(targets == std::set<std::string>(smpl.joint_names.begin(), smpl.joint_names.end()));
        CHECK(sources.size() == 24);
        CHECK(map.legs == std::vector<std::vector<std::string>>{{"left_hip", "left_knee", "left_ankle"},
                                                                {"right_hip", "right_knee", "right_ankle"}});
    }
}

TEST_CASE("SMPL's own style is the identity, all limbs aligned") {
    const Skeleton<double> smpl = skeleton_of(smpl_joint_names());
    const JointMap map = smpl_joint_map(MotionStyle::smpl, smpl);
    CHECK_NOTHROW(map.require_joints(smpl, smpl));
    for (const JointPair& pair : map.pairs) {
        CHECK(pair.source == pair.target);
    }
    CHECK(map.find("left_collar")->towards == "left_shoulder");
    CHECK(map.find("neck")->towards == "head");
    CHECK(map.find("spine2")->towards.empty());
    CHECK(map.find("left_hand")->copies_rotation == false);
    CHECK(map.find("left_wrist")->copies_rotation);
    CHECK(map.find("thumb") == nullptr);
}

TEST_CASE("CMU's two sets of names") {
    const Skeleton<double> smpl = skeleton_of(smpl_joint_names());
    const Skeleton<double> cmu = skeleton_of(cmu_names);
    const JointMap map = smpl_joint_map(MotionStyle::cmu, cmu);
    CHECK_NOTHROW(map.require_joints(smpl, cmu));
    CHECK(map.find("right_hand")->source == "rhand");
    CHECK(map.find("right_wrist")->source == "RightWrist");
    CHECK(map.find("left_collar")->towards.empty());
    CHECK(map.find("left_elbow")->towards == "left_wrist");
    const JointMap other = smpl_joint_map(MotionStyle::cmu, skeleton_of({"Hips", "LeftUpLeg"}));
    CHECK(other.find("left_shoulder")->source == "LeftArm");
    CHECK(other.find("right_hand")->source == "RightFingerBase");
}

TEST_CASE("MakeHuman's names") {
    const JointMap map = smpl_joint_map(MotionStyle::makehuman, skeleton_of({"root"}));
    CHECK(map.find("left_knee")->source == "lowerleg01.L");
    CHECK(map.find("right_wrist")->source == "wrist.R");
}

TEST_CASE("joints that are not there are refused by name") {
    const Skeleton<double> smpl = skeleton_of(smpl_joint_names());
    const Skeleton<double> cmu = skeleton_of(cmu_names);
    const JointMap map = smpl_joint_map(MotionStyle::fair, cmu);
    CHECK(refusal([&] { map.require_joints(smpl, cmu); }) == "joint map: the source skeleton has no joint 'Spine'");
    CHECK(refusal([&] { map.require_joints(cmu, smpl); }) == "joint map: the target skeleton has no joint 'pelvis'");
    JointMap broken;
    broken.pairs = {{"pelvis", "pelvis", "spine1"}};
    CHECK(refusal([&] { broken.require_joints(smpl, smpl); }) ==
          "joint map: 'pelvis' is aligned towards 'spine1', which has no source joint");
    broken.pairs = {{"pelvis", "pelvis"}};
    broken.legs = {{"pelvis"}};
    CHECK(refusal([&] { broken.require_joints(smpl, smpl); }) ==
          "joint map: a leg of 1 joints, expected at least hip and ankle");
    broken.legs = {{"pelvis", "head"}};
    CHECK(refusal([&] { broken.require_joints(smpl, smpl); }) ==
          "joint map: the leg's joint 'head' has no source joint");
}
