// SPDX-License-Identifier: MIT
/// @file
/// What retarget_motion reads, a body's skeleton and a motion, and how the result is put on the floor.
#pragma once

#include "../support/amass_motion.hpp"
#include "../support/embedded_human.hpp"

#include <softtissue/io/bvh.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/skinning/joint_map.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

namespace examples {

using namespace softtissue;

struct Body {
    Skeleton<double> skeleton;
    double sole = 0.0;  // height of the lowest vertex at rest
};

inline Body read_body(const std::string& path) {
    if (path.empty()) {
        return {{human_joint_names(), KinematicTree(human_parents()), human_rest_joints()}};
    }
    const SmplBody<double> body = read_smpl_body<double>(path, SmplSurface::any);
    const auto names = body.joint_names.empty() ? smpl_joint_names() : body.joint_names;
    return {{names, body.tree, body.template_vertices * body.joint_regressor.transpose()},
            body.template_vertices.row(1).minCoeff()};
}

/// Files in AMASS's layout hold no skeleton: their rotations are those of a body of the same size that starts in a T-pose,
/// or in this body's rest pose if its file has no `tpose_pose`.
inline BvhClip<double> read_amass(const std::string& motion, bool z_up, const std::string& body_file,
                                  const Skeleton<double>& body) {
    BvhClip<double> clip{body, {}, {}};
    if (motion.empty()) {
        clip.motion = embedded_motion();
        return clip;
    }
    clip.motion = read_motion(motion, body.num_joints());
    const NpzFile file = read_npz(body_file);
    if (file.contains("tpose_pose")) {
        Pose<double> tpose = Pose<double>::rest(body.num_joints());
        const VectorX<double> turns = file.at("tpose_pose").vector<double>();
        require(turns.size() == tpose.rotation_vectors.size(), body_file, ": tpose_pose has ", turns.size(),
                " numbers");
        tpose.rotation_vectors.reshaped() = turns;
        clip.skeleton.joints = posed_joints(joint_transforms(body.tree, body.joints, tpose), body.joints);
    }
    if (z_up) {
        const Vector3<double> root = clip.skeleton.joints.col(0);
        const Vector3<double> quarter_turn(-std::numbers::pi / 2, 0, 0);
        const Matrix3<double> R = rotation_matrix_from_rotation_vector<double>(quarter_turn);
        for (Pose<double>& pose : clip.motion.poses) {
            pose.translation = R * (pose.translation + root) - root;
            pose.rotation_vectors.col(0) = rotation_vector_from_rotation_matrix<double>(R * local_rotation(pose, 0));
        }
    }
    return clip;
}

/// Moves the motion so that the lowest foot joint (but for 2 % of the frames) is as far above y = 0 as above the sole at rest.
inline void place_on_floor(const Body& body, Motion<double>& motion) {
    const Skeleton<double>& skeleton = body.skeleton;
    std::vector<double> heights;
    for (const Pose<double>& pose : motion.poses) {
        const auto x = posed_joints(joint_transforms(skeleton.tree, skeleton.joints, pose), skeleton.joints);
        for (const char* foot : {"left_ankle", "right_ankle", "left_foot", "right_foot"}) {
            const Index j = skeleton.joint(foot);
            heights.push_back(x(1, j) - (skeleton.joints(1, j) - body.sole));
        }
    }
    std::sort(heights.begin(), heights.end());
    for (Pose<double>& pose : motion.poses) {
        pose.translation.y() -= heights[heights.size() / 50 / 4];
    }
}

}  // namespace examples
