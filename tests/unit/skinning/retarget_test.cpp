// SPDX-License-Identifier: MIT
#include <softtissue/skinning/retarget.hpp>

#include <softtissue/core/random.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#if __has_include(<zip.h>)
#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/bvh.hpp>
#include <softtissue/io/npz.hpp>
#endif

using namespace softtissue;
using softtissue_test::refusal;

namespace {

const std::vector<std::int32_t> smpl_parents{-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                             9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};

/// A person of simple numbers; the arms hang by `droop` below the horizontal.
template <class S>
Skeleton<S> person(double thigh = 0.4, double shin = 0.4, double hip = 0.1, double droop = 0.0) {
    Matrix3X<double> x = Matrix3X<double>::Zero(3, 24);
    const double leg = thigh + shin;
    const auto set = [&](Index j, double px, double py, double pz) { x.col(j) << px, py, pz; };
    set(0, 0, leg + 0.15, 0), set(3, 0, leg + 0.25, 0.01), set(6, 0, leg + 0.4, 0), set(9, 0, leg + 0.5, -0.01);
    set(12, 0, leg + 0.7, 0), set(15, 0, leg + 0.8, 0.03);
    for (const Index side : {0, 1}) {
        const double s = side == 0 ? 1 : -1;
        set(1 + side, s * hip, leg + 0.1, 0), set(4 + side, s * hip, shin + 0.1, 0.01);
        set(7 + side, s * hip, 0.1, 0), set(10 + side, s * hip, 0.02, 0.15);
        set(13 + side, s * 0.05, leg + 0.65, 0), set(16 + side, s * 0.2, leg + 0.65, 0);
        const double along[4] = {0.25, 0.25, 0.1, 0};
        for (Index k = 0; k < 3; ++k) {
            const Index from = 16 + side + 2 * k;
            x.col(from + 2) = x.col(from) + along[k] * Vector3<double>(s * std::cos(droop), -std::sin(droop), 0);
        }
    }
    return {smpl_joint_names(), KinematicTree(smpl_parents), x.template cast<S>()};
}

template <class S>
Pose<S> random_pose(RandomGenerator& random, double angle) {
    Pose<S> pose = Pose<S>::rest(24);
    for (S& entry : pose.rotation_vectors.leftCols(22).reshaped()) {  // hands stay on their wrists
        entry = S(angle * random.normal());
    }
    for (S& entry : pose.translation) {
        entry = S(random.normal());
    }
    return pose;
}

template <class S>
Matrix3X<S> posed(const Skeleton<S>& skeleton, const Pose<S>& pose) {
    return posed_joints(joint_transforms(skeleton.tree, skeleton.joints, pose), skeleton.joints);
}

template <class S>
Retargeter<S> make_retargeter(const Skeleton<S>& source, const Skeleton<S>& target, RetargetOptions<S> options = {}) {
    return Retargeter<S>(source, target, smpl_joint_map(MotionStyle::smpl, source), options);
}

}  // namespace

TEST_CASE_TEMPLATE("a motion on its own skeleton is that motion", S, float, double) {
    RandomGenerator random(1);
    const Skeleton<S> skeleton = person<S>();
    const Retargeter<S> retarget = make_retargeter(skeleton, skeleton);
    CHECK(retarget.scale() == S(1));
    CHECK(retarget.axes() == Matrix3<S>::Identity());
    Motion<S> motion;
    motion.frame_rate = S(60);
    for (int t = 0; t < 5; ++t) {
        motion.poses.push_back(random_pose<S>(random, 0.3));
    }
    RetargetReport<S> report;
    const Motion<S> result = retarget(motion, report);
    const S tolerance = std::is_same_v<S, double> ? S(1e-13) : S(1e-5);
    CHECK(result.frame_rate == S(60));
    CHECK(report.poses == 5);
    CHECK(report.not_converged == 0);
    CHECK(report.largest_foot_error < tolerance);
    for (size_t t = 0; t < 5; ++t) {
        CHECK((result.poses[t].rotation_vectors - motion.poses[t].rotation_vectors).norm() < tolerance);
        CHECK((result.poses[t].translation - motion.poses[t].translation).norm() < tolerance);
    }
}

TEST_CASE("other units and other axes make no difference") {
    RandomGenerator random(2);
    const Skeleton<double> target = person<double>();
    Matrix3<double> to_z_up;  // x to the left, z up, facing -y
    to_z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    Skeleton<double> source = target;
    source.joints = 40.0 * to_z_up * target.joints;
    const Pose<double> pose = random_pose<double>(random, 0.3);
    Pose<double> source_pose{to_z_up * pose.rotation_vectors, 40.0 * to_z_up * pose.translation};
    const Retargeter<double> retarget = make_retargeter(source, target);
    CHECK(retarget.axes() == to_z_up.transpose());
    CHECK(retarget.scale() == doctest::Approx(1.0 / 40.0).epsilon(1e-14));
    RetargetReport<double> report;
    const Pose<double> result = retarget(source_pose, report);
    CHECK((result.rotation_vectors - pose.rotation_vectors).norm() < 1e-12);
    CHECK((result.translation - pose.translation).norm() < 1e-12);
}

TEST_CASE("arms that hang at rest are stretched like the source's") {
    RandomGenerator random(3);
    const Skeleton<double> source = person<double>();
    const Skeleton<double> target = person<double>(0.4, 0.4, 0.1, 0.8);
    const Retargeter<double> retarget = make_retargeter(source, target);
    for (const double angle : {0.0, 0.4}) {
        const Pose<double> pose = random_pose<double>(random, angle);
        RetargetReport<double> report;
        const Matrix3X<double> x = posed(target, retarget(pose, report));
        CHECK((x - posed(source, pose)).norm() < 1e-6);
    }
}

TEST_CASE("other proportions: the hips and the feet are where the source's are, rotations stay close") {
    RandomGenerator random(4);
    const Skeleton<double> source = person<double>(0.45, 0.4, 0.12);
    const Skeleton<double> target = person<double>(0.35, 0.4, 0.09);
    const Retargeter<double> retarget = make_retargeter(source, target);
    const Retargeter<double> copy = make_retargeter(source, target, {.plants_feet = false});
    CHECK(retarget.scale() == doctest::Approx(0.75 / 0.85).epsilon(1e-3));
    for (int trial = 0; trial < 5; ++trial) {
        Pose<double> pose = random_pose<double>(random, 0.2);
        pose.rotation_vectors.col(4) << 0.6, 0, 0;  // bent knees: stretched ones cannot reach farther
        pose.rotation_vectors.col(5) << 0.6, 0, 0;
        RetargetReport<double> report, copied;
        const Pose<double> planted = retarget(pose, report);
        const Pose<double> rotated = copy(pose, copied);
        const Matrix3X<double> wanted = retarget.scale() * posed(source, pose);
        const Matrix3X<double> x = posed(target, planted);
        CHECK(((x.col(1) + x.col(2)) - (wanted.col(1) + wanted.col(2))).norm() < 1e-12);
        CHECK(std::max((x.col(7) - wanted.col(7)).norm(), (x.col(8) - wanted.col(8)).norm()) ==
              doctest::Approx(report.largest_foot_error));
        CHECK(report.largest_foot_error < 0.003);
        CHECK(report.largest_foot_error < 0.1 * copied.largest_foot_error);
        CHECK((planted.rotation_vectors - rotated.rotation_vectors).colwise().norm().maxCoeff() < 0.4);
        for (const Index j : {0, 3, 6, 9, 12, 15, 16, 18, 20}) {  // nothing but the legs
            CHECK(planted.rotation_vectors.col(j) == rotated.rotation_vectors.col(j));
        }
    }
}

TEST_CASE("what does not fit is refused") {
    const Skeleton<double> skeleton = person<double>();
    JointMap map = smpl_joint_map(MotionStyle::smpl, skeleton);
    map.legs.clear();
    CHECK(refusal([&] { Retargeter<double>(skeleton, skeleton, map); }) == "retarget: the joint map has no legs");
    Skeleton<double> flat = skeleton;
    flat.joints.setZero();
    CHECK(refusal([&] { make_retargeter(flat, skeleton); }) ==
          "retarget: legs of length 0 in the source and 1.600499922 in the target, expected > 0");
    Skeleton<double> nameless = skeleton;
    nameless.joint_names.clear();
    CHECK(refusal([&] { make_retargeter(skeleton, nameless); }) == "retarget: target: 0 joint names, expected 24");
    RetargetReport<double> report;
    CHECK(!refusal([&] {
               static_cast<void>(make_retargeter(skeleton, skeleton)(Pose<double>::rest(3), report));
           }).empty());
}

#if __has_include(<zip.h>)
namespace {

/// The body of the data folder; no joints where it is not there.
Skeleton<double> data_body(const std::filesystem::path& data) {
    const std::filesystem::path path = data / "body/body_small.npz";
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: " << path.string() << " is not there");
        return {};
    }
    const NpzFile file = read_npz(path);
    return {file.at("joint_names").strings(), KinematicTree(smpl_parents), file.at("J").columns3<double>()};
}

/// The angle between the local rotations of a joint in two poses [degrees].
double angle_between(const Pose<double>& a, const Pose<double>& b, Index joint) {
    const Matrix3<double> R = local_rotation(a, joint).transpose() * local_rotation(b, joint);
    return rotation_vector_from_rotation_matrix<double>(R).norm() * 180.0 / std::numbers::pi;
}

}  // namespace

TEST_CASE("clips agree with what another program made of them") {
    const std::filesystem::path data = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data";
    const Skeleton<double> body = data_body(data);
    if (body.joint_names.empty()) {
        return;
    }
    struct Clip {
        std::string source, result;
        MotionStyle style;
        size_t first, stride;
        std::vector<Index> same_joints;
        double degrees;
    };
    // The other program turned CMU's neck and arms by constant angles, which is not done here, and smoothed both motions:
    // feet and wrists much, the rest of the second one lightly.
    const std::vector<Clip> clips{
        {"cmu_jumping_jacks", "jumping_jacks", MotionStyle::cmu, 0, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 14}, 1e-3},
        {"fair_jumping",
         "jump",
         MotionStyle::fair,
         150,
         2,
         {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 13, 14, 15, 16, 17, 18, 19},
         1.4}};
    for (const Clip& clip : clips) {
        CAPTURE(clip.source);
        const BvhClip<double> source = read_bvh<double>(data / "mocap" / (clip.source + ".bvh"));
        const Motion<double> expected = read_amass_motion<double>(data / "motion" / (clip.result + ".npz"), 24);
        const JointMap map = smpl_joint_map(clip.style, source.skeleton);
        const Retargeter<double> copy(source.skeleton, body, map, {.plants_feet = false});
        const Retargeter<double> plant(source.skeleton, body, map);
        RetargetReport<double> copied, planted;
        double largest = 0.0, moved = 0.0;
        Matrix3X<double> pelvis(3, 0), expected_pelvis(3, 0);
        for (size_t t = 0; t < expected.poses.size(); ++t) {
            const Pose<double>& pose = source.motion.poses[clip.first + clip.stride * t];
            const Pose<double> result = copy(pose, copied);
            for (const Index j : clip.same_joints) {
                largest = std::max(largest, angle_between(result, expected.poses[t], j));
            }
            if (t % 10 == 0) {
                const Pose<double> standing = plant(pose, planted);
                for (Index j = 0; j < 24; ++j) {
                    moved = std::max(moved, angle_between(result, standing, j));
                }
            }
            // The other program turned the whole motion about the vertical and moved it.
            const Matrix3<double> turn = local_rotation(expected.poses[0], 0) *
                                         local_rotation(copy(source.motion.poses[clip.first], copied), 0).transpose();
            const auto n = Index(t) + 1;
            pelvis.conservativeResize(3, n);
            expected_pelvis.conservativeResize(3, n);
            pelvis.col(n - 1) = turn * (result.translation + body.joints.col(0));
            expected_pelvis.col(n - 1) = expected.poses[t].translation + body.joints.col(0);
        }
        CHECK(largest < clip.degrees);
        const Matrix3X<double> difference = pelvis - expected_pelvis;
        const Matrix3X<double> spread = difference.colwise() - difference.rowwise().mean();
        CHECK(spread.colwise().norm().maxCoeff() < 0.005);
        CHECK(planted.not_converged == 0);
        CHECK(copied.largest_foot_error > 0.01);
        CHECK(planted.largest_foot_error < 0.002);
        CHECK(moved < 7.0);
    }
}

TEST_CASE("MakeHuman's T-pose is the body's T-pose") {
    const std::filesystem::path data = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data";
    const Skeleton<double> body = data_body(data);
    if (body.joint_names.empty()) {
        return;
    }
    const BvhClip<double> source = read_bvh<double>(data / "makehuman/poses/tpose.bvh", 0.1);
    const Retargeter<double> retarget(source.skeleton, body, smpl_joint_map(MotionStyle::makehuman, source.skeleton));
    CHECK(retarget.scale() == doctest::Approx(1.0).epsilon(0.02));
    RetargetReport<double> report;
    const Matrix3X<double> x = posed(body, retarget(source.motion.poses[0], report));
    for (const Index side : {0, 1}) {
        const Vector3<double> arm = x.col(20 + side) - x.col(16 + side);
        CHECK(std::abs(arm.x()) > 0.97 * arm.norm());
    }
}
#endif
