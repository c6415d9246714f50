// SPDX-License-Identifier: MIT
/// @file
/// The mesh of a glTF file as one surface: triangles, skinning weights and morph targets of all its parts together.
///
/// What        read_gltf_surface(): the primitives of a mesh one after the other, as they are in the file.
/// Shapes      positions 3 x n, triangles 3 x m, weights one row per vertex, morph targets 3 x n each.
/// Parts       triangles, strips and fans; with or without indices; any number of JOINTS_k and WEIGHTS_k.
/// Weights     normalised; a sum within 1e-3 (floats) or half a step per entry (integers) of one is rounding and not counted
/// Refuses     no triangles, an index or a joint out of range, arrays of different lengths, weights that are negative or all
///             zero, other kinds of parts (InvalidInput names file, element and vertex).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.7
/// Tests       tests/unit/io/gltf_surface_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_document.hpp>
#include <softtissue/io/gltf_repairs.hpp>
#include <softtissue/io/json_element.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

struct GltfSurface {
    Matrix3X<double> positions;
    Triangles triangles;
    std::vector<std::vector<JointWeight<double>>> weights;  ///< per vertex, joints of the skin ascending
    std::vector<Matrix3X<double>> morph_targets;            ///< offsets
    std::vector<std::int32_t> welded_vertex;                ///< of each vertex in the file (gltf_welding.hpp)
    std::vector<std::int32_t> hole_centers;  ///< vertices that are not in the file (gltf_hole_filling.hpp)
    GltfRepairs repairs;
};

/// The mean of the weights of some vertices, joints ascending.
inline std::vector<JointWeight<double>> mean_weights(const GltfSurface& surface, const std::vector<Index>& vertices) {
    std::map<std::int32_t, double> mean;
    for (const Index v : vertices) {
        for (const auto& [joint, weight] : surface.weights[static_cast<std::size_t>(v)]) {
            mean[joint] += weight / double(vertices.size());
        }
    }
    std::vector<JointWeight<double>> row;
    for (const auto& [joint, weight] : mean) {
        row.push_back({joint, weight});
    }
    return row;
}

namespace detail {

/// Corners of the triangles of a part with `n` vertices.
inline std::vector<std::int32_t> read_corners(GltfDocument& document, const JsonElement& part, Index n) {
    std::vector<std::int32_t> corners(static_cast<std::size_t>(n));
    std::iota(corners.begin(), corners.end(), 0);
    if (part.has("indices")) {
        const JsonElement reference = part.at("indices");
        const GltfValues indices = document.read(reference, "SCALAR");
        const int type = indices.component_type;
        require(type == 5121 || type == 5123 || type == 5125, reference.name(), ": componentType = ", type,
                ", expected an unsigned integer");
        corners.resize(static_cast<std::size_t>(indices.values.cols()));
        for (Index i = 0; i < indices.values.cols(); ++i) {
            const double value = indices.values(0, i);
            require(value < double(n), reference.name(), ": index ", i, " = ", value, ", expected 0 to ", n - 1);
            corners[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(value);
        }
    }
    return corners;
}

/// Appends the triangles of a part whose vertices begin at `first`.
inline void append_triangles(GltfDocument& document, const JsonElement& part, Index n, std::int32_t first,
                             std::vector<std::int32_t>& triangles) {
    const Index mode = part.has("mode") ? part.at("mode").integer(0, 6) : 4;
    require(mode >= 4, part.name(), ".mode = ", mode, ", expected triangles (4), a strip (5) or a fan (6)");
    const std::vector<std::int32_t> corners = read_corners(document, part, n);
    const std::size_t count = corners.size();
    require(mode != 4 || count % 3 == 0, part.name(), ": has ", count,
            " corners of triangles, expected a multiple of 3");
    for (std::size_t i = 0; i + 2 < count; i += mode == 4 ? 3 : 1) {
        std::array<std::size_t, 3> places{i, i + 1, i + 2};
        if (mode == 5 && i % 2 == 1) {
            std::swap(places[1], places[2]);
        } else if (mode == 6) {
            places = {i + 1, i + 2, 0};
        }
        for (const std::size_t place : places) {
            triangles.push_back(first + corners[place]);
        }
    }
}

/// Adds one JOINTS_k, WEIGHTS_k to the rows from `first` on; returns how far the sum of a row may be from one.
inline double append_weight_set(GltfDocument& document, const JsonElement& attributes, int set, Index n,
                                Index num_joints, std::vector<JointWeight<double>>* rows) {
    const JsonElement joints = attributes.at("JOINTS_" + std::to_string(set));
    const JsonElement weights = attributes.at("WEIGHTS_" + std::to_string(set));
    const GltfValues joint_values = document.read(joints, "VEC4");
    const GltfValues weight_values = document.read(weights, "VEC4");
    require(joint_values.component_type == 5121 || joint_values.component_type == 5123, joints.name(),
            ": componentType = ", joint_values.component_type, ", expected 5121 or 5123");
    const int type = weight_values.component_type;
    require(type == 5126 || ((type == 5121 || type == 5123) && weight_values.is_normalized), weights.name(),
            ": componentType = ", type, ", expected 5126, or 5121 or 5123 normalized");
    for (const auto& [reference, columns] :
         {std::pair{&joints, joint_values.values.cols()}, std::pair{&weights, weight_values.values.cols()}}) {
        require(columns == n, reference->name(), ": has ", columns, " elements, expected ", n, " as POSITION");
    }
    for (Index v = 0; v < n; ++v) {
        for (Index k = 0; k < 4; ++k) {
            const double weight = weight_values.values(k, v);
            require(weight >= 0.0, weights.name(), ": weight ", k, " of vertex ", v, " = ", weight, ", expected >= 0");
            if (weight > 0.0) {
                const double joint = joint_values.values(k, v);
                require(joint < double(num_joints), joints.name(), ": joint ", k, " of vertex ", v, " = ", joint,
                        ", expected 0 to ", num_joints - 1);
                rows[v].push_back({static_cast<std::int32_t>(joint), weight});
            }
        }
    }
    return type == 5126 ? 1e-3 : type == 5121 ? 2.0 / 255.0 : 2.0 / 65535.0;
}

/// Ascending joints, each once, normalised.
inline void finish_weights(std::vector<JointWeight<double>>& row, double tolerance, const std::string& part,
                           Index vertex, GltfRepairs& repairs) {
    std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.joint < b.joint; });
    std::vector<JointWeight<double>> joined;
    double sum = 0.0;
    for (const auto& [joint, weight] : row) {
        sum += weight;
        if (!joined.empty() && joined.back().joint == joint) {
            joined.back().weight += weight;
        } else {
            joined.push_back({joint, weight});
        }
    }
    require(sum > 0.0, part, ": weights of vertex ", vertex, " are all zero, expected a sum of 1");
    if (std::abs(sum - 1.0) > tolerance) {
        repairs.count_rescaled(std::abs(sum - 1.0));
    }
    for (auto& entry : joined) {
        entry.weight /= sum;
    }
    row = std::move(joined);
}

/// The parts of a mesh one after the other, as they grow.
struct SurfaceParts {
    std::vector<double> positions;
    std::vector<std::int32_t> corners;
    std::vector<std::vector<JointWeight<double>>> weights;
    std::vector<std::vector<double>> morph_targets;
    GltfRepairs repairs;
};

inline void append_columns(const MatrixX<double>& columns, std::vector<double>& numbers) {
    numbers.insert(numbers.end(), columns.data(), columns.data() + columns.size());
}

inline void append_part(GltfDocument& document, const JsonElement& part, Index num_joints, SurfaceParts& parts) {
    const JsonElement attributes = part.at("attributes");
    const MatrixX<double> positions = document.read(attributes.at("POSITION"), "VEC3").values;
    const std::size_t first = parts.weights.size();
    const Index n = positions.cols();
    require(Index(first) + n < std::numeric_limits<std::int32_t>::max(), part.name(), ": too many vertices");
    append_triangles(document, part, n, static_cast<std::int32_t>(first), parts.corners);
    append_columns(positions, parts.positions);
    parts.weights.resize(first + static_cast<std::size_t>(n));
    double tolerance = 0.0;
    for (int set = 0; set == 0 || attributes.has("JOINTS_" + std::to_string(set)); ++set) {
        tolerance += append_weight_set(document, attributes, set, n, num_joints, parts.weights.data() + first);
    }
    for (Index v = 0; v < n; ++v) {
        finish_weights(parts.weights[first + static_cast<std::size_t>(v)], tolerance, part.name(), v, parts.repairs);
    }
    const std::vector<JsonElement> targets = part.items("targets");
    require(targets.size() == parts.morph_targets.size(), part.name(), ": has ", targets.size(),
            " morph targets, expected ", parts.morph_targets.size(), " as the first part of the mesh");
    for (std::size_t k = 0; k < targets.size(); ++k) {
        MatrixX<double> offsets;
        if (targets[k].has("POSITION")) {
            offsets = document.read(targets[k].at("POSITION"), "VEC3").values;
        } else {
            document.claim(targets[k], 3, n);
            offsets.setZero(3, n);
        }
        require(offsets.cols() == n, targets[k].name(), ".POSITION: has ", offsets.cols(), " elements, expected ", n);
        append_columns(offsets, parts.morph_targets[k]);
    }
}

inline Matrix3X<double> as_columns(const std::vector<double>& numbers) {
    return Eigen::Map<const Matrix3X<double>>(numbers.data(), 3, static_cast<Index>(numbers.size() / 3));
}

}  // namespace detail

/// The mesh element `mesh`, whose weights may name `num_joints` joints.
inline GltfSurface read_gltf_surface(GltfDocument& document, const JsonElement& mesh, Index num_joints) {
    detail::SurfaceParts parts;
    const std::vector<JsonElement> elements = mesh.items("primitives");
    require(!elements.empty(), mesh.name(), ": has no primitives");
    parts.morph_targets.resize(elements.front().items("targets").size());
    for (const JsonElement& element : elements) {
        detail::append_part(document, element, num_joints, parts);
    }
    require(!parts.corners.empty(), mesh.name(), ": has no triangles");
    GltfSurface surface;
    surface.positions = detail::as_columns(parts.positions);
    surface.triangles = Eigen::Map<const Triangles>(parts.corners.data(), 3, Index(parts.corners.size() / 3));
    surface.weights = std::move(parts.weights);
    surface.repairs = parts.repairs;
    for (const std::vector<double>& target : parts.morph_targets) {
        surface.morph_targets.push_back(detail::as_columns(target));
    }
    surface.welded_vertex.resize(surface.weights.size());
    std::iota(surface.welded_vertex.begin(), surface.welded_vertex.end(), 0);
    return surface;
}

}  // namespace softtissue
