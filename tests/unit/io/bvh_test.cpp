// SPDX-License-Identifier: MIT
#include <softtissue/io/bvh.hpp>

#include "io_test_support.hpp"

#include <softtissue/skinning/joint_transforms.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace softtissue;
using namespace io_test;

namespace {

const std::string hierarchy =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 1 0\n\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\n"
    "\tJOINT Upper Leg\n\t{\n\t\tOFFSET 0.5 -.25 +0.125\n\t\tCHANNELS 3 Yrotation Xrotation Zrotation\n"
    "\t\tJOINT foot:L {\n\t\t\tOFFSET 0 -1e0 0\n\t\t\tCHANNELS 1 Xrotation\n\t\t\tEnd Site\n\t\t\t{\n"
    "\t\t\t\tOFFSET 0 0 2\n\t\t\t}\n\t\t}\n\t}\n}\n";
const std::string motion = "MOTION\nFrames:\t2\nFrame Time: .05\n0 1 0 0 0 0 0 0 0 0\n1 2 3 90 0 0 10 20 30 45\n";

template <RealScalar S = double>
BvhClip<S> read(const std::string& text, double scale = 1.0) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.bvh", text);
    return read_bvh<S>(folder / "a.bvh", scale);
}

std::string refused(const std::string& text) {
    return refusal([&] { static_cast<void>(read(text)); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

Matrix3<double> turn(int axis, double degrees) {
    return rotation_matrix_from_rotation_vector<double>(Vector3<double>::Unit(axis) *
                                                        (degrees * std::numbers::pi / 180));
}

/// A skeleton of two joints whose second one has positions (x, y, z) in each of two frames.
std::string sliding(const std::string& first, const std::string& second) {
    return "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation JOINT b { OFFSET 0 2 0 CHANNELS 3 "
           "Xposition Yposition Zposition End Site { OFFSET 0 1 0 } } } MOTION Frames: 2 Frame Time: 1 0 0 0 " +
           first + " 0 0 0 " + second;
}

}  // namespace

TEST_CASE_TEMPLATE("names, tree, rest positions, end sites and frame rate", S, float, double) {
    const BvhClip<S> clip = read<S>(hierarchy + motion, 2.0);
    const Skeleton<S>& skeleton = clip.skeleton;
    CHECK(skeleton.joint_names == std::vector<std::string>{"Hips", "Upper Leg", "foot:L"});
    CHECK(skeleton.tree.parents() == std::vector<std::int32_t>{-1, 0, 1});
    CHECK(skeleton.joints.col(0) == Vector3<S>(0, 2, 0));
    CHECK(skeleton.joints.col(1) == Vector3<S>(1, S(1.5), S(0.25)));
    CHECK(skeleton.joints.col(2) == Vector3<S>(1, S(-0.5), S(0.25)));
    CHECK(clip.end_sites.size() == 1);
    CHECK(clip.end_sites[0].joint == 2);
    CHECK(clip.end_sites[0].position == Vector3<S>(1, S(-0.5), S(4.25)));
    CHECK(clip.motion.num_frames() == 2);
    CHECK(clip.motion.frame_rate == S(20));
    CHECK(clip.motion.poses[0].rotation_vectors.isZero(0));
    CHECK(clip.motion.poses[0].translation.isZero(0));
    CHECK(clip.motion.poses[1].translation == Vector3<S>(2, 2, 6));
}

TEST_CASE("rotations are applied in the order of their channels") {
    const Pose<double> pose = read(hierarchy + motion).motion.poses[1];
    CHECK((local_rotation(pose, 0) - turn(2, 90)).norm() < 1e-14);
    CHECK((local_rotation(pose, 1) - turn(1, 10) * turn(0, 20) * turn(2, 30)).norm() < 1e-14);
    CHECK((local_rotation(pose, 2) - turn(0, 45)).norm() < 1e-14);
}

TEST_CASE("the root's position is that of its channels") {
    const BvhClip<double> clip = read(hierarchy + motion);
    const auto transforms = joint_transforms(clip.skeleton.tree, clip.skeleton.joints, clip.motion.poses[1]);
    const Matrix3X<double> joints = posed_joints(transforms, clip.skeleton.joints);
    CHECK((joints.col(0) - Vector3<double>(1, 2, 3)).norm() < 1e-14);
    CHECK((joints.col(1) - Vector3<double>(1.25, 2.5, 3.125)).norm() < 1e-14);
}

TEST_CASE("line ends, one line, and joints without channels make no difference") {
    const BvhClip<double> expected = read(hierarchy + motion);
    std::string crlf = hierarchy + motion;
    for (std::size_t place = 0; (place = crlf.find('\n', place)) != std::string::npos; place += 2) {
        crlf.replace(place, 1, "\r\n");
    }
    std::string one_line = hierarchy + motion;
    std::replace(one_line.begin(), one_line.end(), '\n', ' ');
    for (const std::string& text : {crlf, one_line}) {
        const BvhClip<double> clip = read(text);
        CHECK(clip.motion.poses[1].rotation_vectors == expected.motion.poses[1].rotation_vectors);
    }
    const std::string fixed = replaced(hierarchy, "CHANNELS 1 Xrotation", "CHANNELS 0");
    CHECK(read(fixed + replaced(replaced(motion, "0 0 0 0\n1", "0 0 0\n1"), " 45", "")).motion.num_frames() == 2);
}

TEST_CASE("positions of other joints may repeat the offset or be displacements that vanish, not move bones") {
    CHECK(read(sliding("0 2 0", "0 2.01 0")).motion.num_frames() == 2);
    CHECK(read(sliding("0 0 0", "0.01 0 0")).motion.num_frames() == 2);
    CHECK(contains(refused(sliding("0 2 0", "0 0 0")), "a.bvh: joint 'b' moves by 2 m against its parent"));
    CHECK(contains(refused(sliding("0 0.1 0", "0 0 0")), "expected rigid bones"));
}

TEST_CASE("another grammar is refused with its line") {
    const auto refused_with = [](const std::string& from, const std::string& to) {
        return refused(replaced(hierarchy + motion, from, to));
    };
    CHECK(contains(refused(""), "a.bvh: line 1: found '', expected HIERARCHY"));
    CHECK(contains(refused("hello"), "line 1: found 'hello', expected HIERARCHY"));
    CHECK(contains(refused_with("ROOT", "JOINT"), "line 2: found 'JOINT', expected ROOT"));
    CHECK(contains(refused_with("\tOFFSET 0 1 0\n", ""), "in joint 'Hips', expected one OFFSET"));
    CHECK(contains(refused_with("OFFSET 0 1 0", "OFFSET 0 1"), "line 5: found 'CHANNELS', expected a finite number"));
    CHECK(contains(refused_with("OFFSET 0 1 0", "OFFSET 0 nan 0"), "line 4: found 'nan', expected a finite number"));
    CHECK(contains(refused_with("OFFSET 0 1 0", "OFFSET 0 1e999 0"), "found '1e999', expected a finite number"));
    CHECK(contains(refused_with("OFFSET 0 1 0", "OFFSET 0 1 0 OFFSET 0 1 0"), "found 'OFFSET' in joint 'Hips'"));
    CHECK(contains(refused_with("CHANNELS 6 X", "CHANNELS 6 W"), "found 'Wposition', expected a channel"));
    CHECK(contains(refused_with("CHANNELS 6", "CHANNELS 7"), "found 'JOINT', expected a channel"));
    CHECK(contains(refused_with("CHANNELS 6", "CHANNELS 5"), "found 'Yrotation' in joint 'Hips'"));
    CHECK(contains(refused_with("CHANNELS 6", "CHANNELS -6"), "expected a whole number"));
    CHECK(contains(refused_with("CHANNELS 6", "CHANNELS 99999999999999999999"), "expected a whole number"));
    CHECK(contains(refused_with("CHANNELS 1 Xrotation", "CHANNELS 1 XRotation"), "found 'XRotation'"));
    CHECK(contains(refused_with("foot:L", "Hips"), "a.bvh: joint name 'Hips' appears twice"));
    CHECK(
        contains(refused_with("ROOT Hips\n{", "ROOT Hips\n"), "line 4: found 'OFFSET' after joint 'Hips', expected {"));
    CHECK(contains(refused_with("MOTION", "ROOT two { OFFSET 0 0 0 } MOTION"), "found 'ROOT', expected MOTION"));
    CHECK(contains(refused("HIERARCHY ROOT a { OFFSET 0 0 0 } MOTION Frames: 1 Frame Time: 1"),
                   "0 channels for 1 joints, expected at least as many"));
}

TEST_CASE("another number of frames than stated is refused") {
    const auto refused_with = [](const std::string& from, const std::string& to) {
        return refused(hierarchy + replaced(motion, from, to));
    };
    CHECK(contains(refused_with("\t2", "3"), "expected Frames:"));
    CHECK(contains(refused_with("\t2", "\t3"), "line 25: found '', expected a finite number"));
    CHECK(contains(refused_with("\t2", "\t1"), "numbers after the last of 1 frames"));
    CHECK(contains(refused_with("\t2", "\t1000000000000"), "found '', expected a finite number"));
    CHECK(contains(refused_with("\t2", "\t0"), "0 frames of 0.05 s, expected at least one frame"));
    CHECK(contains(refused_with("\t2", "\t2.5"), "found '2.5', expected a whole number"));
    CHECK(contains(refused_with(".05", "0"), "2 frames of 0 s, expected"));
    CHECK(contains(refused_with(".05", "-1"), "a time > 0"));
    CHECK(contains(refused_with(" 45\n", " 45x\n"), "found '45x', expected a finite number"));
}

TEST_CASE("what is finite in the file but not in memory is refused") {
    const auto refused_as_float = [](const std::string& from, const std::string& to) {
        return refusal([&] { static_cast<void>(read<float>(replaced(hierarchy + motion, from, to))); });
    };
    CHECK(contains(refused_as_float("OFFSET 0 0 2", "OFFSET 0 0 1e39"), "an end site of joint 2 is not finite"));
    CHECK(contains(refused_as_float("1 2 3 90", "1e39 2 3 90"), "frame 1: translation is not finite"));
    CHECK(contains(refused_as_float(" 90 ", " 1e300 "), "frame 1, joint 0: rotation is not finite"));
    CHECK(contains(refused_as_float(".05", "1e-320"), "frame rate is inf"));
}

TEST_CASE("a file cut off anywhere is refused") {
    const std::string whole = hierarchy + motion;
    for (std::size_t size = 0; size + 3 < whole.size();
         ++size) {  // without its last digit the number 45 is a number still
        CAPTURE(size);
        CHECK(contains(refused(whole.substr(0, size)), "a.bvh"));
    }
}

TEST_CASE("what is no file is refused by name") {
    CHECK(contains(refusal([] { static_cast<void>(read_bvh<double>("/none/a.bvh")); }), "/none/a.bvh: is no file"));
    CHECK(contains(refusal([] { static_cast<void>(read_bvh<double>("/")); }), "is no file"));
    CHECK(contains(refusal([] { static_cast<void>(read(hierarchy + motion, 0.0)); }), "scale is 0, expected > 0"));
}

TEST_CASE("the captures of the data folder are read") {
    const std::filesystem::path data = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data";
    if (!std::filesystem::exists(data)) {
        MESSAGE("skipped: no folder " << data.string());
        return;
    }
    const BvhClip<double> jacks = read_bvh<double>(data / "mocap/cmu_jumping_jacks.bvh");
    CHECK(jacks.skeleton.num_joints() == 31);
    CHECK(jacks.motion.num_frames() == 125);
    CHECK(std::abs(jacks.motion.frame_rate - 30.003) < 1e-3);
    CHECK(jacks.end_sites.size() == 7);
    const BvhClip<double> jump = read_bvh<double>(data / "mocap/fair_jumping.bvh");
    CHECK(jump.skeleton.num_joints() == 27);
    CHECK(jump.motion.num_frames() == 654);
    CHECK(std::abs(jump.motion.frame_rate - 119.875) < 1e-3);
    const BvhClip<double> tpose = read_bvh<double>(data / "makehuman/poses/tpose.bvh", 0.1);
    CHECK(tpose.skeleton.num_joints() == 173);
    const Vector3<double> thigh = tpose.skeleton.joints.col(tpose.skeleton.joint("lowerleg01.L")) -
                                  tpose.skeleton.joints.col(tpose.skeleton.joint("upperleg02.L"));
    CHECK(thigh.norm() == doctest::Approx(0.3227).epsilon(1e-3));
}
