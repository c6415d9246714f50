// SPDX-License-Identifier: MIT
/// @file
/// Reads a rigged character from a glTF file (.glb, .gltf): any joints, any hierarchy.
///
/// What        one skinned mesh of the file with its skin and all clips. Vertices at one place are one (weld).
/// Rest        the bind pose of the file, moved to where the root joint is without animation: T_root = I there. So vertices,
///             joints and morph targets are in the units and axes of the scene, whatever stands above the skeleton.
/// Example     const GltfCharacter character = read_gltf_character("hero.glb");
/// Refuses     a file without skinned mesh, several ones and none named, nodes that form no tree, bind matrices that are singular
///             or no affine maps; what io/gltf_document.hpp, io/gltf_surface.hpp and io/gltf_clip.hpp refuse (InvalidInput names
///             file, element, index, value, expectation).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.5, 3.7.3
/// Departs     the node of a skinned mesh does not place it (as specified); materials, cameras and the like are not read.
/// Needs       nlohmann-json
/// Tests       tests/unit/io/gltf_reader_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_character.hpp>
#include <softtissue/io/gltf_clip.hpp>
#include <softtissue/io/gltf_document.hpp>
#include <softtissue/io/gltf_hole_filling.hpp>
#include <softtissue/io/gltf_surface.hpp>
#include <softtissue/io/gltf_welding.hpp>
#include <softtissue/io/json_element.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

struct GltfReadOptions {
    std::string mesh = {};  ///< name of the skinned mesh or its node; empty: the only one
    bool weld = true;
    bool fill_holes = false;  ///< gltf_hole_filling.hpp; needs weld
};

namespace detail {

/// Column-major 4 x 4.
inline AffineTransform<double> affine_transform(const VectorX<double>& numbers, const std::string& name) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(numbers.data());
    require((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= 1e-6, name, ": its last row is ",
            matrix.row(3), ", expected 0 0 0 1");
    return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

/// False also where the map is not finite.
inline bool is_invertible(const AffineTransform<double>& map) {
    const double size = map.linear.norm();
    return std::abs(determinant(map.linear, cofactor(map.linear))) > 1e-9 * size * size * size &&
           map.translation.allFinite();
}

inline void read_nodes(GltfDocument& document, GltfCharacter& character) {
    std::vector<GltfNode>& nodes = character.nodes;
    nodes.resize(size_t(document.count("nodes")));
    std::vector<std::vector<std::int32_t>> children(nodes.size());
    for (size_t n = 0; n < nodes.size(); ++n) {
        const JsonElement element = document.element("nodes", Index(n));
        GltfNode& node = nodes[n];
        node.name = element.has("name") ? element.at("name").text() : std::to_string(n);
        if (element.has("matrix")) {
            node.has_matrix = true;
            node.matrix = affine_transform(element.at("matrix").numbers(16), element.name() + ".matrix");
        }
        if (element.has("translation")) {
            node.translation = element.at("translation").numbers(3);
        }
        if (element.has("scale")) {
            node.scale = element.at("scale").numbers(3);
        }
        if (element.has("rotation")) {
            const VectorX<double> xyzw = element.at("rotation").numbers(4);
            require(std::abs(xyzw.norm() - 1.0) <= 0.1, element.name(), ".rotation has length ", xyzw.norm(),
                    ", expected 1");
            node.rotation = Quaternion<double>(xyzw(3), xyzw(0), xyzw(1), xyzw(2)).normalized();
        }
        for (const JsonElement& item : element.items("children")) {
            const Index child = document.index(item, "nodes");
            require(nodes[size_t(child)].parent == GltfNode::none && child != Index(n), item.name(), " = ", child,
                    ", a node that has a parent already, expected a tree");
            nodes[size_t(child)].parent = static_cast<std::int32_t>(n);
            children[n].push_back(static_cast<std::int32_t>(child));
        }
    }
    std::vector<std::int32_t>& order = character.node_order;
    for (size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n].parent == GltfNode::none) {
            order.push_back(static_cast<std::int32_t>(n));
        }
    }
    for (size_t next = 0; next < order.size(); ++next) {
        const auto& below = children[size_t(order[next])];
        order.insert(order.end(), below.begin(), below.end());
    }
    std::vector<bool> reached(nodes.size(), false);
    for (const std::int32_t n : order) {
        reached[size_t(n)] = true;
    }
    for (size_t n = 0; n < nodes.size(); ++n) {
        require(reached[n], document.file(), ": nodes[", n, "] (", nodes[n].name,
                ") is its own ancestor, expected a tree");
    }
}

/// The node with a mesh and a skin that is meant.
inline std::int32_t skinned_node(const GltfDocument& document, const std::string& wanted) {
    std::int32_t found = GltfNode::none;
    std::string names;
    Index count = 0;
    for (Index n = 0; n < document.count("nodes"); ++n) {
        const JsonElement node = document.element("nodes", n);
        if (!node.has("mesh") || !node.has("skin")) {
            continue;
        }
        const JsonElement mesh = document.element("meshes", document.index(node.at("mesh"), "meshes"));
        const std::string node_name = node.has("name") ? node.at("name").text() : std::to_string(n);
        const std::string name = mesh.has("name") ? mesh.at("name").text() : node_name;
        if (wanted.empty() || wanted == name || wanted == node_name) {
            found = static_cast<std::int32_t>(n);
            ++count;
        }
        names += (names.empty() ? "" : ", ") + name;
    }
    require(!names.empty(), document.file(), ": has no skinned mesh (no node with mesh and skin)");
    require(count > 0, document.file(), ": no skinned mesh '", wanted, "'; it has ", names);
    require(count == 1, document.file(), ": has ", count, " skinned meshes (", names, "), expected the name of one");
    return found;
}

inline void read_skin(GltfDocument& document, const JsonElement& skin, GltfCharacter& character) {
    const std::vector<JsonElement> joints = skin.items("joints");
    require(!joints.empty(), skin.name(), ": has no joints");
    std::vector<bool> used(character.nodes.size(), false);
    for (const JsonElement& joint : joints) {
        const Index node = document.index(joint, "nodes");
        require(!used[size_t(node)], joint.name(), " = ", node, " appears twice");
        used[size_t(node)] = true;
        character.joint_nodes.push_back(static_cast<std::int32_t>(node));
        character.joint_names.push_back(character.nodes[size_t(node)].name);
    }
    character.inverse_bind.resize(joints.size());
    if (skin.has("inverseBindMatrices")) {
        const JsonElement reference = skin.at("inverseBindMatrices");
        const MatrixX<double> matrices = document.read(reference, "MAT4").values;
        require(matrices.cols() >= Index(joints.size()), reference.name(), ": has ", matrices.cols(),
                " matrices, expected ", joints.size());
        for (size_t j = 0; j < joints.size(); ++j) {
            const std::string name = reference.name() + ", matrix " + std::to_string(j);
            character.inverse_bind[j] = affine_transform(matrices.col(Index(j)), name);
            require(is_invertible(character.inverse_bind[j]), name, " is singular, expected an invertible map");
        }
    }
}

inline void read_morphs(const JsonElement& node, const JsonElement& mesh, GltfCharacter& character) {
    const Index count = static_cast<Index>(character.morph_targets.size());
    character.morph_weights.setZero(count);
    for (const JsonElement* owner : {&mesh, &node}) {
        if (owner->has("weights")) {
            character.morph_weights = owner->at("weights").numbers(count);
        }
    }
    for (Index k = 0; k < count; ++k) {
        character.morph_names.push_back(std::to_string(k));
    }
    if (mesh.has("extras") && mesh.value()["extras"].is_object() && mesh.at("extras").has("targetNames")) {
        const std::vector<JsonElement> names = mesh.at("extras").items("targetNames");
        for (size_t k = 0; k < std::min(names.size(), size_t(count)); ++k) {
            character.morph_names[k] = names[k].text();
        }
    }
}

/// Moves the bind pose to where the root joint is without animation.
inline void move_rest_into_scene(const std::string& file, GltfCharacter& character) {
    std::vector<size_t> joint_of(character.nodes.size(), character.joint_nodes.size());
    for (size_t j = 0; j < character.joint_nodes.size(); ++j) {
        joint_of[size_t(character.joint_nodes[j])] = j;
    }
    size_t root = character.joint_nodes.size();  // the first joint in the order of the tree
    for (const std::int32_t n : character.node_order) {
        root = root == character.joint_nodes.size() ? joint_of[size_t(n)] : root;
    }
    const AffineTransform<double> M = character.joint_transforms()[root];
    require(is_invertible(M), file, ": joint '", character.joint_names[root],
            "' is placed by a singular map, expected an invertible one");
    const AffineTransform<double> back = M.inverse();
    for (Index v = 0; v < character.num_vertices(); ++v) {
        character.positions.col(v) = M(character.positions.col(v));
        require(character.positions.col(v).allFinite(), file, ": vertex ", v, " is not finite in the scene");
    }
    for (Matrix3X<double>& target : character.morph_targets) {
        target = (M.linear * target).eval();
    }
    for (AffineTransform<double>& B : character.inverse_bind) {
        B = B * back;
    }
    if (determinant(M.linear, cofactor(M.linear)) < 0.0) {
        character.triangles.row(1).swap(character.triangles.row(2));
    }
}

}  // namespace detail

/// The skinned mesh of `path` with everything that moves it.
inline GltfCharacter read_gltf_character(const std::filesystem::path& path, const GltfReadOptions& options = {}) {
    GltfDocument document(path);
    GltfCharacter character;
    detail::read_nodes(document, character);
    character.mesh_node = detail::skinned_node(document, options.mesh);
    const JsonElement node = document.element("nodes", character.mesh_node);
    const JsonElement mesh = document.element("meshes", document.index(node.at("mesh"), "meshes"));
    character.source = document.file() + ": mesh '" + (mesh.has("name") ? mesh.at("name").text() : mesh.name()) + "'";
    detail::read_skin(document, document.element("skins", document.index(node.at("skin"), "skins")), character);

    GltfSurface surface = read_gltf_surface(document, mesh, character.num_joints());
    if (options.weld) {
        surface = welded_surface(surface, character.source);
    }
    require(options.weld || !options.fill_holes, character.source, ": holes are filled in a welded surface only");
    if (options.fill_holes) {
        surface = filled_surface(std::move(surface), character.source);
    }
    character.positions = std::move(surface.positions);
    character.triangles = std::move(surface.triangles);
    character.weights = SkinningWeights<double>(character.num_joints(), surface.weights);
    character.morph_targets = std::move(surface.morph_targets);
    character.welded_vertex = std::move(surface.welded_vertex);
    character.hole_centers = std::move(surface.hole_centers);
    character.repairs = surface.repairs;
    detail::read_morphs(node, mesh, character);
    character.clips = read_gltf_clips(document);
    detail::move_rest_into_scene(document.file(), character);
    return character;
}

}  // namespace softtissue
