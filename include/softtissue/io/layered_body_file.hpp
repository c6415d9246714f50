// SPDX-License-Identifier: MIT
/// @file
/// A layered body with its skeleton in a file (.npz), and the other shapes of the same body in small ones.
///
/// What        SkeletalLayers: layered body, rest joints, tree and joint names.
///             write_layered_body: rest_positions (V, 3), cells (C, 6), weights (V, J), prescribed, triangles (T, 3),
///             body_triangles, body_vertices, region_vertices, loops (all after each other), loop_sizes, cut_distance,
///             skin_offsets (columns, 3), joints (J, 3), parents (J), joint_names (J or none).
///             write_body_shape: betas, joints, rest_positions, skin_offsets; read_body_shape gives a whole body again.
/// Valid       The construction's report is not stored, nor the cut distances of other shapes than the first.
/// Units       m
/// Refuses     what write_npz() and read_npz() refuse; arrays that do not fit together (InvalidInput names file and array)
/// Tests       tests/unit/io/layered_body_file_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/ndg/shaped_body.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct SkeletalLayers {
    ShapedBody<S> body;
    KinematicTree tree{{KinematicTree::no_parent}};
    std::vector<std::string> joint_names;  // empty, or one per joint
};

namespace detail {

inline NpyArray index_array(const std::vector<std::int32_t>& values) {
    return NpyArray::from_values(std::span<const std::int32_t>(values), {Index(values.size())});
}

template <RealScalar S>
NpyArray vector_array(const VectorX<S>& values) {
    return NpyArray::from_values(std::span<const S>(values.data(), size_t(values.size())), {values.size()});
}

/// Integers of which each must lie from `low` to `high`.
inline std::vector<std::int32_t> read_indices(const NpyArray& array, std::int32_t low, Index high) {
    std::vector<std::int32_t> values = array.as<std::int32_t>();
    for (size_t i = 0; i < values.size(); ++i) {
        require(values[i] >= low && values[i] <= high, array.source(), ": element ", i, " is ", values[i],
                ", expected ", low, " to ", high);
    }
    return values;
}

inline void require_none_or(Index expected, const NpyArray& array) {
    require(array.num_elements() == 0 || array.num_elements() == expected, array.source(), ": has ",
            array.num_elements(), " elements, expected none or ", expected);
}

template <int rows>
Connectivity<rows> read_connectivity(const NpyArray& array, Index num_vertices) {
    read_indices(array, 0, num_vertices - 1);
    return array.columns<std::int32_t, rows>();
}

template <RealScalar S>
Matrix3X<S> read_positions(const NpyArray& array, Index expected) {
    array.require_shape({expected, 3});
    Matrix3X<S> result = array.columns3<S>();
    require(result.allFinite(), array.source(), ": expected finite values");
    return result;
}

}  // namespace detail

template <RealScalar S>
void write_layered_body(const std::filesystem::path& path, const SkeletalLayers<S>& file) {
    const LayeredBody<S>& layered = file.body.layered;
    std::vector<std::int32_t> loops, loop_sizes;
    for (const std::vector<std::int32_t>& loop : layered.region.loops) {
        loops.insert(loops.end(), loop.begin(), loop.end());
        loop_sizes.push_back(std::int32_t(loop.size()));
    }
    NpyArrays arrays{{"rest_positions", NpyArray::from_columns(layered.mesh.rest_positions)},
                     {"cells", NpyArray::from_columns(layered.mesh.cells)},
                     {"weights", NpyArray::from_matrix(layered.weights.dense())},
                     {"prescribed", detail::index_array(layered.prescribed)},
                     {"triangles", NpyArray::from_columns(layered.region.triangles)},
                     {"body_triangles", detail::index_array(layered.region.body_triangles)},
                     {"body_vertices", detail::index_array(layered.region.body_vertices)},
                     {"region_vertices", detail::index_array(layered.region.region_vertices)},
                     {"loops", detail::index_array(loops)},
                     {"loop_sizes", detail::index_array(loop_sizes)},
                     {"cut_distance", detail::vector_array(layered.region.cut_distance)},
                     {"skin_offsets", NpyArray::from_columns(layered.skin_offsets)},
                     {"joints", NpyArray::from_columns(file.body.joints)},
                     {"parents", detail::index_array(file.tree.parents())}};
    if (!file.joint_names.empty()) {
        arrays["joint_names"] = NpyArray::from_strings(file.joint_names, {Index(file.joint_names.size())});
    }
    write_npz(path, arrays);
}

template <RealScalar S>
SkeletalLayers<S> read_layered_body(const std::filesystem::path& path) {
    const NpzFile file = read_npz(path);
    SkeletalLayers<S> result;
    LayeredBody<S>& layered = result.body.layered;
    SimulatedRegion<S>& region = layered.region;
    layered.skin_offsets = detail::read_positions<S>(file.at("skin_offsets"), NpyArray::any);
    const Index columns = layered.skin_offsets.cols();
    require(columns > 0, file.path(), ": a body without skin, expected at least one column");
    layered.layers = {columns, 2};
    const Index vertices = layered.layers.num_vertices();
    layered.mesh.rest_positions = detail::read_positions<S>(file.at("rest_positions"), vertices);
    layered.mesh.cells = detail::read_connectivity<6>(file.at("cells"), vertices);
    layered.weights = SkinningWeights<S>(file.at("weights").matrix<S>());
    require(layered.weights.num_vertices() == vertices, file.path(), ": weights of ", layered.weights.num_vertices(),
            " vertices, expected ", vertices);
    layered.prescribed = detail::read_indices(file.at("prescribed"), 0, vertices - 1);
    region.triangles = detail::read_connectivity<3>(file.at("triangles"), columns);
    require(layered.mesh.num_cells() == 2 * region.num_triangles(), file.path(), ": ", layered.mesh.num_cells(),
            " cells, expected two for each of ", region.num_triangles(), " triangles");
    region.region_vertices = detail::read_indices(file.at("region_vertices"), -1, columns - 1);
    region.body_vertices = detail::read_indices(file.at("body_vertices"), 0, Index(region.region_vertices.size()) - 1);
    region.body_triangles =
        detail::read_indices(file.at("body_triangles"), 0, std::numeric_limits<std::int32_t>::max());
    detail::require_none_or(columns, file.at("body_vertices"));
    detail::require_none_or(region.num_triangles(), file.at("body_triangles"));
    const std::vector<std::int32_t> loops = detail::read_indices(file.at("loops"), 0, columns - 1);
    size_t begin = 0;
    for (const std::int32_t size : detail::read_indices(file.at("loop_sizes"), 0, Index(loops.size()))) {
        require(begin + size_t(size) <= loops.size(), file.path(), ": loop_sizes exceed the ", loops.size(),
                " vertices of loops");
        region.loops.emplace_back(loops.begin() + std::ptrdiff_t(begin),
                                  loops.begin() + std::ptrdiff_t(begin + size_t(size)));
        begin += size_t(size);
    }
    region.cut_distance = file.at("cut_distance").vector<S>();
    detail::require_none_or(columns, file.at("cut_distance"));
    require((region.cut_distance.array() >= S(0)).all(), file.at("cut_distance").source(), ": expected distances >= 0");
    result.tree = KinematicTree(file.at("parents").as<std::int32_t>());
    result.body.joints = detail::read_positions<S>(file.at("joints"), result.tree.num_joints());
    require(layered.weights.num_joints() == result.tree.num_joints(), file.path(), ": weights for ",
            layered.weights.num_joints(), " joints, expected ", result.tree.num_joints());
    if (file.contains("joint_names")) {
        result.joint_names = file.at("joint_names").strings();
        detail::require_none_or(result.tree.num_joints(), file.at("joint_names"));
    }
    return result;
}

/// The part of a body that differs from shape to shape.
template <RealScalar S>
void write_body_shape(const std::filesystem::path& path, const ShapedBody<S>& body, const VectorX<S>& betas) {
    write_npz(path, {{"betas", detail::vector_array(betas)},
                     {"joints", NpyArray::from_columns(body.joints)},
                     {"rest_positions", NpyArray::from_columns(body.layered.mesh.rest_positions)},
                     {"skin_offsets", NpyArray::from_columns(body.layered.skin_offsets)}});
}

/// The body of this shape; all else from `same`, a body of the same maker.
template <RealScalar S>
ShapedBody<S> read_body_shape(const std::filesystem::path& path, ShapedBody<S> same) {
    const NpzFile file = read_npz(path);
    same.joints = detail::read_positions<S>(file.at("joints"), same.joints.cols());
    same.layered.mesh.rest_positions =
        detail::read_positions<S>(file.at("rest_positions"), same.layered.mesh.num_vertices());
    same.layered.skin_offsets = detail::read_positions<S>(file.at("skin_offsets"), same.layered.num_columns());
    same.layered.report = {};
    return same;
}

}  // namespace softtissue
