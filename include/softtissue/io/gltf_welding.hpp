// SPDX-License-Identifier: MIT
/// @file
/// One vertex at each place of a surface: files store a vertex several times where the texture or the normal jumps.
///
/// What        welded_surface(): the first vertex of each place stands for all; where their weights differ it gets their mean.
///             Triangles that lose a corner are left out. Both are counted (gltf_repairs.hpp).
/// Shapes      as GltfSurface
/// Refuses     a surface that loses all its triangles (InvalidInput)
/// Tests       tests/unit/io/gltf_welding_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_repairs.hpp>
#include <softtissue/io/gltf_surface.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace softtissue {

namespace detail {

/// The largest difference of a weight between the first of the vertices and another.
inline double weight_difference(const GltfSurface& surface, const std::vector<Index>& vertices) {
    double difference = 0.0;
    for (const Index v : vertices) {
        std::map<std::int32_t, double> change;
        for (const auto& [joint, weight] : surface.weights[static_cast<std::size_t>(v)]) {
            change[joint] += weight;
        }
        for (const auto& [joint, weight] : surface.weights[static_cast<std::size_t>(vertices.front())]) {
            change[joint] -= weight;
        }
        for (const auto& [joint, weight] : change) {
            difference = std::max(difference, std::abs(weight));
        }
    }
    return difference;
}

}  // namespace detail

/// The surface with one vertex at each place; `source` starts messages.
inline GltfSurface welded_surface(const GltfSurface& surface, const std::string& source) {
    GltfSurface welded;
    welded.repairs = surface.repairs;
    std::map<std::array<double, 3>, std::int32_t> vertex_at;
    std::vector<std::vector<Index>> origins;  // of each place
    for (Index v = 0; v < surface.positions.cols(); ++v) {
        std::array<double, 3> place{};
        for (std::size_t d = 0; d < 3; ++d) {
            place[d] = surface.positions(static_cast<Index>(d), v) + 0.0;  // -0 is 0
        }
        const auto [found, is_new] = vertex_at.emplace(place, static_cast<std::int32_t>(origins.size()));
        if (is_new) {
            origins.emplace_back();
        }
        origins[static_cast<std::size_t>(found->second)].push_back(v);
        welded.welded_vertex.push_back(found->second);
    }
    for (const std::vector<Index>& vertices : origins) {
        const double difference = detail::weight_difference(surface, vertices);
        if (difference > 0.0) {
            welded.repairs.count_averaged(difference);
        }
        welded.weights.push_back(difference > 0.0 ? mean_weights(surface, vertices)
                                                  : surface.weights[static_cast<std::size_t>(vertices.front())]);
    }
    const auto picked = [&](const Matrix3X<double>& columns) {
        Matrix3X<double> result(3, static_cast<Index>(origins.size()));
        for (Index i = 0; i < result.cols(); ++i) {
            result.col(i) = columns.col(origins[static_cast<std::size_t>(i)].front());
        }
        return result;
    };
    welded.positions = picked(surface.positions);
    for (const Matrix3X<double>& target : surface.morph_targets) {
        welded.morph_targets.push_back(picked(target));
    }
    std::vector<std::int32_t> corners;
    for (Index t = 0; t < surface.triangles.cols(); ++t) {
        std::array<std::int32_t, 3> c{};
        for (std::size_t k = 0; k < 3; ++k) {
            c[k] = welded.welded_vertex[static_cast<std::size_t>(surface.triangles(static_cast<Index>(k), t))];
        }
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
            ++welded.repairs.lost_triangles;
        } else {
            corners.insert(corners.end(), c.begin(), c.end());
        }
    }
    require(!corners.empty(), source, ": all ", surface.triangles.cols(),
            " triangles have two corners at one place, expected a surface");
    welded.triangles = Eigen::Map<const Triangles>(corners.data(), 3, static_cast<Index>(corners.size() / 3));
    return welded;
}

}  // namespace softtissue
