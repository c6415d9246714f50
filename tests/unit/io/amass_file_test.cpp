// SPDX-License-Identifier: MIT
#include <softtissue/io/amass_file.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

constexpr Index joints = 3;

NpyArrays sample_arrays() {
    NpyArrays arrays;
    arrays["poses"] = NpyArray::from_matrix(
        MatrixX<double>::NullaryExpr(4, 3 * joints, [](Index t, Index k) { return double(t) + 0.1 * double(k); }));
    arrays["trans"] =
        NpyArray::from_matrix(MatrixX<double>::NullaryExpr(4, 3, [](Index t, Index k) { return double(10 * t + k); }));
    arrays["mocap_framerate"] = NpyArray::from_scalar(60.0);
    return arrays;
}

/// The text of the refusal of the sample with one array replaced.
std::string refused_with(const std::string& name, const NpyArray& replacement) {
    const TemporaryFolder folder;
    NpyArrays arrays = sample_arrays();
    arrays[name] = replacement;
    write_npz(folder / "m.npz", arrays);
    const std::string text = refusal([&] { static_cast<void>(read_amass_motion<double>(folder / "m.npz", joints)); });
    CHECK(text.find((folder / "m.npz").string()) == 0);
    return text;
}

}  // namespace

TEST_CASE_TEMPLATE("a motion is read frame by frame", S, float, double) {
    const TemporaryFolder folder;
    write_npz(folder / "m.npz", sample_arrays());
    const Motion<S> motion = read_amass_motion<S>(folder / "m.npz", joints);
    CHECK(motion.num_frames() == 4);
    CHECK(motion.frame_rate == S(60));
    CHECK(motion.poses[2].rotation_vectors(1, 2) == S(2.0 + 0.1 * 7.0));
    CHECK(motion.poses[3].translation == Vector3<S>(30, 31, 32));
}

TEST_CASE("both spellings of the frame rate, gender and betas are read") {
    const TemporaryFolder folder;
    NpyArrays arrays = sample_arrays();
    arrays["mocap_frame_rate"] = NpyArray::from_scalar(std::int32_t(120));
    arrays.erase("mocap_framerate");
    arrays["gender"] = NpyArray::from_strings({"female"}, {});
    arrays["betas"] = NpyArray::from_values(std::span<const double>(std::vector<double>(10, 0.5)), {10});
    write_npz(folder / "m.npz", arrays);
    const AmassClip<double> clip = read_amass_clip<double>(folder / "m.npz", joints);
    CHECK(clip.motion.frame_rate == 120.0);
    CHECK(clip.gender == "female");
    CHECK(clip.file_joints == joints);
    CHECK(clip.betas == VectorX<double>::Constant(10, 0.5));
}

TEST_CASE_TEMPLATE("what is written is read again", S, float, double) {
    const TemporaryFolder folder;
    write_npz(folder / "m.npz", sample_arrays());
    AmassClip<S> clip = read_amass_clip<S>(folder / "m.npz", joints);
    clip.gender = "neutral";
    clip.betas = VectorX<S>::Ones(2);
    write_amass_clip(folder / "n.npz", clip);
    const AmassClip<S> again = read_amass_clip<S>(folder / "n.npz", joints);
    CHECK(again.motion.num_frames() == 4);
    for (std::size_t t = 0; t < 4; ++t) {
        CHECK(again.motion.poses[t].rotation_vectors == clip.motion.poses[t].rotation_vectors);
        CHECK(again.motion.poses[t].translation == clip.motion.poses[t].translation);
    }
    CHECK(again.motion.frame_rate == clip.motion.frame_rate);
    CHECK(again.gender == "neutral");
    CHECK(again.betas == clip.betas);
}

TEST_CASE("a motion for another skeleton is refused") {
    const TemporaryFolder folder;
    write_npz(folder / "m.npz", sample_arrays());
    CHECK(refusal([&] { static_cast<void>(read_amass_motion<double>(folder / "m.npz", 24)); }) ==
          (folder / "m.npz").string() +
              ": array 'poses': has 9 columns, expected 72 for 24 joints (a motion for another skeleton)");
}

TEST_CASE("files with fingers are refused, or lose them on request") {
    const TemporaryFolder folder;
    for (const Index file_joints : {Index(52), Index(55)}) {
        NpyArrays arrays = sample_arrays();
        const MatrixX<double> poses = MatrixX<double>::NullaryExpr(
            4, 3 * file_joints, [](Index t, Index k) { return double(t) + 0.001 * double(k); });
        arrays["poses"] = NpyArray::from_matrix(poses);
        arrays["gender"] = NpyArray::from_strings({"male"}, {});
        arrays["betas"] = NpyArray::from_values(std::span<const double>(std::vector<double>(16, 0.5)), {16});
        arrays["dmpls"] = NpyArray::from_matrix(MatrixX<double>::Zero(4, 8));
        write_npz(folder / "m.npz", arrays);
        CHECK(contains(refusal([&] { static_cast<void>(read_amass_clip<double>(folder / "m.npz", 24)); }),
                       "expected 72 for 24 joints (a motion for another skeleton: AmassHands::at_rest takes its body"));
        const AmassClip<double> clip = read_amass_clip<double>(folder / "m.npz", 24, AmassHands::at_rest);
        CHECK(clip.file_joints == file_joints);
        for (Index t = 0; t < 4; ++t) {
            const Matrix3X<double>& rotations = clip.motion.poses[std::size_t(t)].rotation_vectors;
            CHECK(rotations.cols() == 24);
            CHECK(rotations.leftCols(22).reshaped() == poses.row(t).head(66).transpose());
            CHECK(rotations.rightCols(2).isZero(0));
        }
        CHECK(clip.gender == "male");
        CHECK(clip.betas == VectorX<double>::Constant(16, 0.5));
        // The skeleton that has the fingers keeps them; no other skeleton gets a part of the joints.
        const auto whole = read_amass_clip<double>(folder / "m.npz", file_joints, AmassHands::at_rest);
        CHECK(whole.motion.poses[1].rotation_vectors.reshaped() == poses.row(1).transpose());
        CHECK(contains(
            refusal([&] { static_cast<void>(read_amass_motion<double>(folder / "m.npz", 22, AmassHands::at_rest)); }),
            "expected 66 for 22 joints (a motion for another skeleton)"));
    }
}

TEST_CASE("shape coefficients are cut or filled up to those of a body") {
    const VectorX<double> betas = VectorX<double>::LinSpaced(4, 1.0, 4.0);
    CHECK(shape_coefficients(betas, 2) == Eigen::Vector2d(1, 2));
    CHECK(shape_coefficients(betas, 5) == (VectorX<double>(5) << 1, 2, 3, 4, 0).finished());
    CHECK(shape_coefficients(VectorX<double>(), 3).isZero(0));
}

TEST_CASE("betas may be a row") {
    const TemporaryFolder folder;
    NpyArrays arrays = sample_arrays();
    arrays["betas"] = NpyArray::from_matrix((MatrixX<double>(1, 3) << 1, 2, 3).finished());
    write_npz(folder / "m.npz", arrays);
    CHECK(read_amass_clip<double>(folder / "m.npz", joints).betas == Eigen::Vector3d(1, 2, 3));
    CHECK(contains(refused_with("betas", NpyArray::from_matrix(MatrixX<double>::Zero(2, 3))), "shape is (2, 3)"));
}

TEST_CASE("arrays that are missing or do not fit are refused") {
    const TemporaryFolder folder;
    for (const char* name : {"poses", "trans", "mocap_framerate"}) {
        NpyArrays arrays = sample_arrays();
        arrays.erase(name);
        write_npz(folder / "m.npz", arrays);
        CHECK(contains(refusal([&] { static_cast<void>(read_amass_motion<double>(folder / "m.npz", joints)); }),
                       std::string("m.npz: array '") + name + "' is missing"));
    }
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(contains(refused_with("trans", NpyArray::from_matrix(MatrixX<double>::Zero(5, 3))),
                   "shape is (5, 3), expected (4, 3)"));
    CHECK(contains(refused_with("poses", NpyArray::from_scalar(1.0)), "expected (any, any)"));
    CHECK(contains(refused_with("poses", NpyArray::from_strings(std::vector<std::string>(36, "a"), {4, 9})),
                   "holds text, expected numbers"));
    CHECK(contains(refused_with("poses", NpyArray::from_matrix(MatrixX<double>::Constant(4, 9, nan))),
                   "frame 0, joint 0: rotation is not finite"));
    CHECK(contains(refused_with("trans", NpyArray::from_matrix(MatrixX<double>::Constant(4, 3, nan))),
                   "translation is not finite"));
    CHECK(contains(refused_with("mocap_framerate", NpyArray::from_scalar(0.0)), "frame rate is 0, expected > 0"));
    CHECK(contains(refused_with("mocap_framerate", NpyArray::from_scalar(nan)), "expected > 0"));
    CHECK(contains(refused_with("betas", NpyArray::from_values(std::span<const double>(&nan, 1), {1})),
                   "expected finite values"));
    CHECK(contains(refused_with("gender", NpyArray::from_strings({"a", "b"}, {2})), "expected one word"));

    NpyArrays empty = sample_arrays();
    empty["poses"] = NpyArray::from_matrix(MatrixX<double>(0, 9));
    empty["trans"] = NpyArray::from_matrix(MatrixX<double>(0, 3));
    write_npz(folder / "m.npz", empty);
    CHECK(contains(refusal([&] { static_cast<void>(read_amass_motion<double>(folder / "m.npz", joints)); }),
                   "the motion has no frames"));
    CHECK(contains(refusal([&] { write_amass_clip(folder / "n.npz", AmassClip<double>()); }),
                   "n.npz: the motion has no frames"));
    CHECK(!std::filesystem::exists(folder / "n.npz"));
}

TEST_CASE("the clips of the data folder are read") {
    const std::filesystem::path motions = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data/motion";
    if (!std::filesystem::exists(motions)) {
        MESSAGE("skipped: no folder " << motions.string());
        return;
    }
    const AmassClip<double> walk = read_amass_clip<double>(motions / "walk.npz", 24);
    CHECK(walk.motion.num_frames() == 172);
    CHECK(walk.motion.frame_rate == 60.0);
    CHECK(walk.gender == "neutral");
    CHECK(walk.betas == VectorX<double>::Zero(10));
}
