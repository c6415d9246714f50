// SPDX-License-Identifier: MIT
/// @file
/// A rigged character: surface, skin weights, skeleton, morph targets and clips, with any joints in any hierarchy.
///
/// What        plain data that skinning policies take, and the transforms of its joints at any time of its clips.
/// Equation    T_j(t) = G_j(t) B_j with the place G_j of joint j's node in the scene and its inverse bind matrix B_j;
///             G = G_parent M, M = translation rotation scale, or the node's matrix
/// Example     const GltfCharacter character = read_gltf_character("hero.glb");
///             const auto T = character.joint_transforms(character.clip("run"), 0.5);
///             policy.prepare_into(T, prepared);
///             x_v = policy.blend(prepared, character.weights.row(v))(character.positions.col(v));
/// Shapes      positions 3 x n, weights n x joints, morph targets 3 x n each; one name, node and bind matrix per joint
/// Units       those of the scene (metres, y up); times in s
/// Refuses     a clip that it does not have, another number of morph weights (InvalidInput names the clips)
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.5, 3.7.3
/// Tests       tests/unit/io/gltf_character_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_clip.hpp>
#include <softtissue/io/gltf_repairs.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/weights.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace softtissue {

/// A node of the scene as it stands without animation.
struct GltfNode {
    static constexpr std::int32_t none = -1;

    std::string name;
    std::int32_t parent = none;
    Vector3<double> translation = Vector3<double>::Zero();
    Quaternion<double> rotation = Quaternion<double>(1, 0, 0, 0);
    Vector3<double> scale = Vector3<double>::Ones();
    bool has_matrix = false;
    AffineTransform<double> matrix = {};  ///< in place of the three

    AffineTransform<double> local() const {
        return has_matrix ? matrix
                          : AffineTransform<double>{
                                rotation_matrix_from_quaternion<double>(rotation) * scale.asDiagonal(), translation};
    }
};

struct GltfCharacter {
    std::string source;  ///< file and mesh, for messages
    Matrix3X<double> positions;
    Triangles triangles;
    SkinningWeights<double> weights;
    std::vector<std::string> joint_names;
    std::vector<std::int32_t> joint_nodes;
    std::vector<AffineTransform<double>> inverse_bind;
    std::vector<std::string> morph_names;
    std::vector<Matrix3X<double>> morph_targets;
    VectorX<double> morph_weights;  ///< without animation
    std::int32_t mesh_node = 0;
    std::vector<GltfNode> nodes;
    std::vector<std::int32_t> node_order;  ///< all nodes, each after its parent
    std::vector<GltfClip> clips;
    std::vector<std::int32_t> welded_vertex;  ///< of each vertex in the file
    std::vector<std::int32_t> hole_centers;   ///< vertices that are not in the file (gltf_hole_filling.hpp)
    GltfRepairs repairs;

    Index num_vertices() const { return positions.cols(); }
    Index num_joints() const { return static_cast<Index>(joint_nodes.size()); }

    const GltfClip& clip(const std::string& name) const {
        std::string names;
        for (const GltfClip& clip : clips) {
            if (clip.name == name) {
                return clip;
            }
            names += (names.empty() ? "" : ", ") + clip.name;
        }
        throw_invalid_input(source, ": no clip '", name, "'; it has ", names.empty() ? "none" : names);
    }

    /// Where the joint is at rest.
    Vector3<double> rest_joint(Index joint) const { return inverse_bind[size_t(joint)].inverse().translation; }

    /// T_j of every joint, without animation.
    std::vector<AffineTransform<double>> joint_transforms() const { return transforms_of(nodes); }

    /// T_j of every joint at a time of a clip.
    std::vector<AffineTransform<double>> joint_transforms(const GltfClip& clip, double time) const {
        std::vector<GltfNode> posed = nodes;
        for (const GltfTrack& track : clip.tracks) {
            GltfNode& node = posed[size_t(track.node)];
            const VectorX<double> value = track.sample(time);
            if (track.property == GltfProperty::translation) {
                node.translation = value;
            } else if (track.property == GltfProperty::rotation) {
                node.rotation = value;
            } else if (track.property == GltfProperty::scale) {
                node.scale = value;
            }
        }
        return transforms_of(posed);
    }

    /// Weights of the morph targets at a time of a clip.
    VectorX<double> morph_weights_at(const GltfClip& clip, double time) const {
        VectorX<double> result = morph_weights;
        for (const GltfTrack& track : clip.tracks) {
            if (track.property == GltfProperty::weights && track.node == mesh_node) {
                result = track.sample(time);
            }
        }
        return result;
    }

    /// The rest surface with morph targets.
    Matrix3X<double> morphed(const VectorX<double>& target_weights) const {
        require(target_weights.size() == Index(morph_targets.size()), source, ": ", target_weights.size(),
                " weights of morph targets, expected ", morph_targets.size());
        Matrix3X<double> result = positions;
        for (Index k = 0; k < target_weights.size(); ++k) {
            result += target_weights(k) * morph_targets[size_t(k)];
        }
        return result;
    }

private:
    std::vector<AffineTransform<double>> transforms_of(const std::vector<GltfNode>& posed) const {
        std::vector<AffineTransform<double>> places(posed.size());
        for (const std::int32_t n : node_order) {
            const GltfNode& node = posed[size_t(n)];
            places[size_t(n)] =
                node.parent == GltfNode::none ? node.local() : places[size_t(node.parent)] * node.local();
        }
        std::vector<AffineTransform<double>> result;
        for (size_t j = 0; j < joint_nodes.size(); ++j) {
            result.push_back(places[size_t(joint_nodes[j])] * inverse_bind[j]);
        }
        return result;
    }
};

}  // namespace softtissue
