// SPDX-License-Identifier: MIT
/// @file
/// Motions in AMASS's file layout (.npz): read, checked, and written.
///
/// What        poses (T, 3 J), trans (T, 3), mocap_framerate (or mocap_frame_rate), optional gender and betas (k);
///             other arrays are ignored.
/// Hands       files for SMPL-H (52 joints, 156 columns) and SMPL-X (55 joints, 165 columns) begin with SMPL's 22 body joints.
///             For a body of 24 joints, AmassHands::at_rest takes those and leaves the body's two hand joints at rest;
///             AmassClip::file_joints tells that it happened. By default such files are refused.
/// Betas       in order of decreasing variance: shape_coefficients() takes the first ones that a body has, zero beyond the
///             last one stated. That is exact within one shape space and a likeness between different ones.
/// Units       axis times angle [rad], root joint first; translation [m], added after posing; frame rate [1/s].
/// Refuses     missing arrays, a motion for another number of joints, a translation track of another length, values that
///             are not finite, a frame rate that is not positive (InvalidInput names the file).
/// Source      Mahmood et al. 2019 (AMASS)
/// Tests       tests/unit/io/amass_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/skinning/motion.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace softtissue {

/// What becomes of a file with finger joints on a body without them.
enum class AmassHands { refuse, at_rest };

/// A motion with the body it was captured from.
template <RealScalar S>
struct AmassClip {
    Motion<S> motion;
    std::string gender;     ///< empty if not stated
    VectorX<S> betas;       ///< shape coefficients, empty if not stated
    Index file_joints = 0;  ///< joints of the file, which may be more than those of the motion
};

/// `betas` for a body of `num_shapes` shapes: its leading coefficients, or zeros after its last one.
template <RealScalar S>
VectorX<S> shape_coefficients(const VectorX<S>& betas, Index num_shapes) {
    VectorX<S> result = VectorX<S>::Zero(num_shapes);
    const Index shared = std::min(num_shapes, betas.size());
    result.head(shared) = betas.head(shared);
    return result;
}

/// The clip in `path` for a skeleton of `num_joints` joints.
template <RealScalar S>
AmassClip<S> read_amass_clip(const std::filesystem::path& path, Index num_joints,
                             AmassHands hands = AmassHands::refuse) {
    constexpr Index smpl_joints = 24, body_joints = 22, smplh_joints = 52, smplx_joints = 55;
    const NpzFile file = read_npz(path);
    const NpyArray& poses = file.at("poses");
    poses.require_shape({NpyArray::any, NpyArray::any});
    const Index frames = poses.shape()[0];
    const Index columns = poses.shape()[1];
    const bool has_fingers = num_joints == smpl_joints && (columns == 3 * smplh_joints || columns == 3 * smplx_joints);
    require(columns == 3 * num_joints || (has_fingers && hands == AmassHands::at_rest), poses.source(), ": has ",
            columns, " columns, expected ", 3 * num_joints, " for ", num_joints,
            " joints (a motion for another skeleton",
            has_fingers ? ": AmassHands::at_rest takes its body without the fingers)" : ")");
    const NpyArray& trans = file.at("trans");
    trans.require_shape({frames, 3});

    AmassClip<S> clip;
    clip.file_joints = columns / 3;
    const Index used_columns = has_fingers ? 3 * body_joints : columns;
    clip.motion.poses.assign(std::size_t(frames), Pose<S>::rest(num_joints));
    poses.for_each<S>([&](Index i, S value) {
        if (i % columns < used_columns) {
            clip.motion.poses[std::size_t(i / columns)].rotation_vectors.data()[i % columns] = value;
        }
    });
    trans.for_each<S>([&](Index i, S value) { clip.motion.poses[std::size_t(i / 3)].translation(i % 3) = value; });
    clip.motion.frame_rate =
        file.at(file.contains("mocap_frame_rate") ? "mocap_frame_rate" : "mocap_framerate").scalar<S>();
    if (file.contains("gender")) {
        const std::vector<std::string> gender = file.at("gender").strings();
        require(gender.size() == 1, file.at("gender").source(), ": expected one word");
        clip.gender = gender.front();
    }
    if (file.contains("betas")) {
        const NpyArray& betas = file.at("betas");
        const bool is_row = betas.shape().size() == 2 && betas.shape()[0] == 1;
        clip.betas = is_row ? VectorX<S>(betas.matrix<S>().transpose()) : betas.vector<S>();
        require(clip.betas.allFinite(), file.at("betas").source(), ": expected finite values");
    }
    clip.motion.validate(file.path(), num_joints);
    return clip;
}

/// The motion alone.
template <RealScalar S>
Motion<S> read_amass_motion(const std::filesystem::path& path, Index num_joints,
                            AmassHands hands = AmassHands::refuse) {
    return read_amass_clip<S>(path, num_joints, hands).motion;
}

/// Writes `clip` in the same layout.
template <RealScalar S>
void write_amass_clip(const std::filesystem::path& path, const AmassClip<S>& clip) {
    const Motion<S>& motion = clip.motion;
    const Index num_joints = motion.poses.empty() ? 0 : motion.poses.front().rotation_vectors.cols();
    motion.validate(path.string(), num_joints);
    MatrixX<S> poses(3 * num_joints, motion.num_frames());
    Matrix3X<S> trans(3, motion.num_frames());
    for (Index t = 0; t < motion.num_frames(); ++t) {
        const Pose<S>& pose = motion.poses[std::size_t(t)];
        poses.col(t) = pose.rotation_vectors.reshaped();
        trans.col(t) = pose.translation;
    }
    NpyArrays arrays;
    arrays["poses"] = NpyArray::from_columns(poses);
    arrays["trans"] = NpyArray::from_columns(trans);
    arrays["mocap_framerate"] = NpyArray::from_scalar(double(motion.frame_rate));
    if (!clip.gender.empty()) {
        arrays["gender"] = NpyArray::from_strings({clip.gender}, {});
    }
    if (clip.betas.size() > 0) {
        arrays["betas"] = NpyArray::from_values(std::span<const S>(clip.betas.data(), std::size_t(clip.betas.size())),
                                                {clip.betas.size()});
    }
    write_npz(path, arrays);
}

}  // namespace softtissue
