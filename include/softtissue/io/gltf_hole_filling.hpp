// SPDX-License-Identifier: MIT
/// @file
/// Closes the holes of a surface (eyes, mouth, neck, cuffs): every boundary loop gets a vertex in its middle.
///
/// What        filled_surface(): each edge of a loop makes a triangle with the loop's centre, which moves as the loop does in the
///             mean: position, weights, morph targets. A closed surface stays as it is.
/// Shapes      as GltfSurface; the centres follow the other vertices, hole_centers names them
/// Use         soft tissue leaves the centres out (RegionOptions::excluded_vertices), so that rims stay on the bones
/// Refuses     edges of more than two triangles or of contrary ones, a loop that passes a vertex twice (InvalidInput)
/// Tests       tests/unit/io/gltf_hole_filling_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_surface.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace softtissue {

namespace detail {

inline std::vector<std::vector<std::int32_t>> hole_rims(const GltfSurface& surface, const std::string& source) {
    try {
        return TriangleMesh(surface.triangles, surface.positions.cols(), source).boundary_loops();
    } catch (const InvalidInput& error) {
        throw_invalid_input(error.what(), "; remove inner and double faces before export, or take another mesh");
    }
}

}  // namespace detail

/// `source` starts messages.
inline GltfSurface filled_surface(GltfSurface surface, const std::string& source) {
    const std::vector<std::vector<std::int32_t>> loops = detail::hole_rims(surface, source);
    const Index n = surface.positions.cols();
    Index num_edges = 0;
    for (const std::vector<std::int32_t>& loop : loops) {
        num_edges += static_cast<Index>(loop.size());
    }
    Index triangle = surface.triangles.cols();
    surface.triangles.conservativeResize(3, triangle + num_edges);
    for (std::size_t k = 0; k < loops.size(); ++k) {
        const std::vector<std::int32_t>& loop = loops[k];
        const auto center = static_cast<std::int32_t>(n + static_cast<Index>(k));
        for (std::size_t i = 0; i < loop.size(); ++i) {
            // The surface runs from i to i + 1, what fills the hole the other way.
            surface.triangles.col(triangle++) << loop[(i + 1) % loop.size()], loop[i], center;
        }
        surface.weights.push_back(mean_weights(surface, {loop.begin(), loop.end()}));
        surface.hole_centers.push_back(center);
    }
    const auto add_means = [&](Matrix3X<double>& columns) {
        columns.conservativeResize(3, n + static_cast<Index>(loops.size()));
        for (std::size_t k = 0; k < loops.size(); ++k) {
            columns.col(n + static_cast<Index>(k)) = columns(Eigen::all, loops[k]).rowwise().mean();
        }
    };
    add_means(surface.positions);
    for (Matrix3X<double>& target : surface.morph_targets) {
        add_means(target);
    }
    return surface;
}

}  // namespace softtissue
