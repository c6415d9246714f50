// SPDX-License-Identifier: MIT
/// @file
/// A rigged character as a body of rigid bones: what avatars and layered bodies are made of.
///
/// What        body(): surface, tree, weights and joints in SMPL's form, morph targets as shapes, no pose blend shapes;
///             motion(): a clip as local rotations and the translation of the root; bone_change(): what is lost by that.
/// Joints      those that move vertices, those between them, and joints at the ends of moving bones. The first is the root. What
///             lies above (a node that only places the character) is not needed: its motion becomes that of the root. Without
///             one joint above all others the first one takes the others as children.
/// Equation    R_j = Q_parent^T Q_j with the rotation Q_j of the joint's transform T_j; translation = T_root c - c
/// Valid       nearly rigid bones, which become rigid: rotation up to largest_stretch, joints up to largest_shift of the longest
///             bone away from where their parent puts them. Joints that move no vertices may do as they like.
/// Refuses     clips that scale, shear or pull bones, joints without extent of the surface around (InvalidInput names joint, clip,
///             time), a frame rate that is not positive
/// Source      Loper et al. 2015 (SMPL), for the form
/// Departs     the joint regressor is the combination of least squares of some vertices that gives the joint, not a learned one
/// Tests       tests/unit/io/character_rig_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_character.hpp>
#include <softtissue/io/gltf_clip.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/pose.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

/// How far a clip changes bones that move skin, at most: what motion() leaves out.
struct BoneChange {
    double stretch = 0.0;  ///< relative
    double shift = 0.0;    ///< [m] of a joint from where its parent puts it
    std::string shifted_joint = {};
};

class CharacterRig {
public:
    static constexpr double largest_stretch = 0.05;
    static constexpr double largest_shift = 0.05;

    /// `character` must outlive the rig.
    explicit CharacterRig(const GltfCharacter& character) : character_(&character) { choose_joints(); }

    Index num_joints() const { return Index(joints_.size()); }
    const KinematicTree& tree() const { return tree_; }

    /// The character's number of joint `joint` of the rig.
    std::int32_t character_joint(Index joint) const { return joints_[size_t(joint)]; }

    SmplBody<double> body() const {
        const GltfCharacter& c = *character_;
        SmplBody<double> body;
        body.template_vertices = c.morphed(c.morph_weights);
        body.faces = c.triangles;
        body.tree = tree_;
        std::vector<std::int32_t> rig_joint(size_t(c.num_joints()), 0);
        for (size_t j = 0; j < joints_.size(); ++j) {
            rig_joint[size_t(joints_[j])] = static_cast<std::int32_t>(j);
            body.joint_names.push_back(c.joint_names[size_t(joints_[j])]);
        }
        std::vector<std::vector<JointWeight<double>>> rows(size_t(c.num_vertices()));
        for (Index v = 0; v < c.num_vertices(); ++v) {
            auto& row = rows[size_t(v)];
            for (const auto& [joint, weight] : c.weights.row(v)) {
                row.push_back({rig_joint[size_t(joint)], weight});
            }
            std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.joint < b.joint; });
        }
        body.weights = SkinningWeights<double>(num_joints(), rows);
        const Index n = c.num_vertices();
        body.shape_directions.resize(3 * n, Index(c.morph_targets.size()));
        for (size_t k = 0; k < c.morph_targets.size(); ++k) {
            body.shape_directions.col(Index(k)) = c.morph_targets[k].reshaped();
        }
        body.pose_directions.resize(3 * n, 9 * (num_joints() - 1));
        body.joint_regressor = regressor(body.template_vertices);
        body.validate(c.source);
        return body;
    }

    /// The clip at `frame_rate` [1/s].
    Motion<double> motion(const GltfClip& clip, double frame_rate) const {
        Motion<double> motion;
        motion.frame_rate = frame_rate;
        for (Index k = 0; k < num_frames(clip, frame_rate); ++k) {
            motion.poses.push_back(pose(clip, clip.start + double(k) / frame_rate));
        }
        return motion;
    }

    /// The clip as often as its densest track has keys, but 30 to 240 times a second.
    Motion<double> motion(const GltfClip& clip) const { return motion(clip, default_frame_rate(clip)); }

    Pose<double> pose(const GltfClip& clip, double time) const {
        const std::vector<AffineTransform<double>> T = character_->joint_transforms(clip, time);
        Pose<double> pose = Pose<double>::rest(num_joints());
        std::vector<Matrix3<double>> Q(joints_.size());
        for (size_t j = 0; j < joints_.size(); ++j) {
            const AffineTransform<double>& own = T[size_t(joints_[j])];
            const auto place = [&] {
                return character_->source + ": joint '" + character_->joint_names[size_t(joints_[j])] + "', clip '" +
                       clip.name + "' at " + std::to_string(time) + " s";
            };
            Q[j] = polar_rotation(own.linear);
            const double stretch = stretch_of(own, Q[j]);
            require(!moves_skin_[j] || stretch <= largest_stretch, place(), ": the bone is scaled or sheared by ",
                    stretch, ", expected at most ", largest_stretch, " (rigid bones)");
            const std::int32_t parent = tree_.parent(Index(j));
            const Vector3<double> c = rest_.col(Index(j));
            if (parent == KinematicTree::no_parent) {
                pose.rotation_vectors.col(Index(j)) = rotation_vector_from_rotation_matrix<double>(Q[j]);
                pose.translation = own(c) - c;
                continue;
            }
            const double shift = shift_of(T, j);
            require(!moves_skin_[j] || shift <= largest_shift * longest_bone_, place(), ": is ", shift,
                    " m from where its parent puts it, expected at most ", largest_shift * longest_bone_,
                    " (rigid bones)");
            const Matrix3<double> local = Q[size_t(parent)].transpose() * Q[j];
            pose.rotation_vectors.col(Index(j)) = rotation_vector_from_rotation_matrix<double>(local);
        }
        return pose;
    }

    /// At the times of motion(clip).
    BoneChange bone_change(const GltfClip& clip) const {
        const double frame_rate = default_frame_rate(clip);
        BoneChange largest;
        for (Index k = 0; k < num_frames(clip, frame_rate); ++k) {
            const std::vector<AffineTransform<double>> T =
                character_->joint_transforms(clip, clip.start + double(k) / frame_rate);
            for (size_t j = 0; j < joints_.size(); ++j) {
                if (!moves_skin_[j]) {
                    continue;
                }
                const AffineTransform<double>& own = T[size_t(joints_[j])];
                largest.stretch = std::max(largest.stretch, stretch_of(own, polar_rotation(own.linear)));
                const double shift = shift_of(T, j);
                if (shift > largest.shift) {
                    largest.shift = shift;
                    largest.shifted_joint = character_->joint_names[size_t(joints_[j])];
                }
            }
        }
        return largest;
    }

private:
    Index num_frames(const GltfClip& clip, double frame_rate) const {
        constexpr double most_frames = 1e6;
        require(std::isfinite(frame_rate) && frame_rate > 0.0, character_->source, ": frame rate is ", frame_rate,
                ", expected > 0");
        const double last = std::floor(clip.duration() * frame_rate + 1e-6);
        require(last < most_frames, character_->source, ": clip '", clip.name, "' lasts ", clip.duration(),
                " s, expected less than ", most_frames, " frames");
        return Index(last) + 1;
    }

    static double default_frame_rate(const GltfClip& clip) { return std::clamp(clip.key_rate(), 30.0, 240.0); }

    static double stretch_of(const AffineTransform<double>& transform, const Matrix3<double>& rotation) {
        return (transform.linear - rotation).cwiseAbs().maxCoeff();
    }

    /// How far joint `j` is from where its parent puts it; 0 for the root.
    double shift_of(const std::vector<AffineTransform<double>>& T, size_t j) const {
        const std::int32_t parent = tree_.parent(Index(j));
        if (parent == KinematicTree::no_parent) {
            return 0.0;
        }
        const Vector3<double> c = rest_.col(Index(j));
        return (T[size_t(joints_[j])](c) - T[size_t(joints_[size_t(parent)])](c)).norm();
    }

    void choose_joints() {
        const GltfCharacter& c = *character_;
        constexpr std::int32_t none = -1;
        std::vector<std::int32_t> joint_of(c.nodes.size(), none);  // of a node
        for (size_t j = 0; j < c.joint_nodes.size(); ++j) {
            joint_of[size_t(c.joint_nodes[j])] = static_cast<std::int32_t>(j);
        }
        std::vector<bool> has_weight(c.joint_nodes.size(), false);
        for (Index v = 0; v < c.num_vertices(); ++v) {
            for (const auto& entry : c.weights.row(v)) {
                has_weight[size_t(entry.joint)] = true;
            }
        }
        // Joints with weights at or below a node, and how many of its children have some.
        std::vector<Index> below(c.nodes.size(), 0), branches(c.nodes.size(), 0);
        for (size_t i = c.node_order.size(); i-- > 0;) {
            const auto n = size_t(c.node_order[i]);
            below[n] += joint_of[n] != none && has_weight[size_t(joint_of[n])] ? 1 : 0;
            if (c.nodes[n].parent != GltfNode::none && below[n] > 0) {
                below[size_t(c.nodes[n].parent)] += below[n];
                ++branches[size_t(c.nodes[n].parent)];
            }
        }
        const Index total = std::count(has_weight.begin(), has_weight.end(), true);
        std::vector<std::int32_t> rig_joint(c.nodes.size(), none),
            parents;  // rig_joint: the nearest at or above a node
        for (const std::int32_t node : c.node_order) {
            const auto n = size_t(node);
            const std::int32_t above =
                c.nodes[n].parent == GltfNode::none ? none : rig_joint[size_t(c.nodes[n].parent)];
            rig_joint[n] = above;
            if (joint_of[n] == none) {
                continue;
            }
            const bool moves = has_weight[size_t(joint_of[n])];
            const bool between = below[n] > 0 && (below[n] < total || branches[n] > 1);
            const bool is_end = below[n] == 0 && above != none && has_weight[size_t(joints_[size_t(above)])];
            if (moves || between || is_end) {
                rig_joint[n] = static_cast<std::int32_t>(joints_.size());
                parents.push_back(above != none || joints_.empty() ? above : 0);
                joints_.push_back(joint_of[n]);
                moves_skin_.push_back(below[n] > 0);
            }
        }
        tree_ = KinematicTree(std::move(parents));
        rest_.resize(3, num_joints());
        for (Index j = 0; j < num_joints(); ++j) {
            rest_.col(j) = c.rest_joint(joints_[size_t(j)]);
            if (j > 0) {
                longest_bone_ = std::max(longest_bone_, (rest_.col(j) - rest_.col(tree_.parent(j))).norm());
            }
        }
    }

    /// Per joint the smallest weights of `num_samples` vertices, or of all, that sum to one and give the joint.
    SmplBody<double>::SparseMatrix regressor(const Matrix3X<double>& vertices) const {
        constexpr Index num_samples = 64;
        for (const Index count : {std::min(num_samples, vertices.cols()), vertices.cols()}) {
            Matrix3X<double> X(3, count);
            for (Index i = 0; i < count; ++i) {
                X.col(i) = vertices.col(i * vertices.cols() / count);
            }
            const Vector3<double> center = X.rowwise().mean();
            X.colwise() -= center;
            Matrix3<double> moments = Matrix3<double>::Zero();
            for (Index i = 0; i < count; ++i) {
                moments += X.col(i) * X.col(i).transpose();
            }
            const Matrix3<double> cof = cofactor(moments);
            const double volume = determinant(moments, cof);
            const double trace = moments.trace();
            if (!(volume > 1e-9 * trace * trace * trace)) {
                continue;
            }
            SmplBody<double>::SparseMatrix result(num_joints(), vertices.cols());
            result.reserve(num_joints() * count);
            for (Index j = 0; j < num_joints(); ++j) {
                const Vector3<double> slope = cof.transpose() * (rest_.col(j) - center) / volume;
                result.startVec(j);
                for (Index i = 0; i < count; ++i) {
                    result.insertBack(j, i * vertices.cols() / count) = 1.0 / double(count) + slope.dot(X.col(i));
                }
            }
            result.finalize();
            return result;
        }
        throw_invalid_input(character_->source, ": all vertices lie in a plane, expected a body");
    }

    const GltfCharacter* character_;
    std::vector<std::int32_t> joints_;  // of the character
    std::vector<bool> moves_skin_;      // itself or a joint below
    KinematicTree tree_{{KinematicTree::no_parent}};
    Matrix3X<double> rest_;
    double longest_bone_ = 0.0;
};

}  // namespace softtissue
