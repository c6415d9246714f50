// SPDX-License-Identifier: MIT
/// @file
/// Moves skin vertices under which no layer could exist, as little as it takes.
///
/// What        repair_skin(): the skin with a validity cone of a wanted width at every vertex, without slivers and crossing
///             triangles, and the best inward direction of every vertex.
/// Method      Vertices whose best cosine is below the wanted one and those of slivers (a corner's sine below the wanted one)
///             move by a share of the way to the mean of their neighbours, all at once, again and again; when none is left,
///             those of crossing triangles. Where that stalls, their neighbours move as well: after first_ring_round rounds
///             one ring, after second_ring_round two; slivers are then left. Vertices on the boundary stay.
/// Valid       the result may fall short (furrows at the boundary, pieces of skin that pass through each other): the caller
///             looks at `cosines` and `crossings`.
/// Source      Nolte et al. 2026, section 4.1 (skin vertices as degrees of freedom)
/// Departs     smoothing of single vertices instead of an optimisation of the whole skin: all others keep their positions
/// Cost        linear per crossing test; a round touches the vertices that move only
/// Tests       tests/unit/anatomy/skin_repair_test.cpp
#pragma once

#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/anatomy/validity_cone.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/umbrella_mean.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct SkinRepairOptions {
    S wanted_cosine = S(0.4);
    S wanted_sine = S(0.08);
    S step = S(0.2);
    int first_ring_round = 15;
    int second_ring_round = 60;
    int max_rounds = 300;
};

template <RealScalar S>
struct RepairedSkin {
    Matrix3X<S> positions;
    Matrix3X<S> directions;                                        // best inward direction of every vertex, unit
    VectorX<S> cosines;                                            // its smallest cosine with the inward normals
    std::vector<std::pair<std::int32_t, std::int32_t>> crossings;  // pairs of triangles that are left
    int rounds = 0;
};

namespace detail {

template <RealScalar S>
class SkinRepair {
public:
    SkinRepair(const TriangleMesh& mesh, const Matrix3X<S>& positions, const SkinRepairOptions<S>& options)
        : mesh_(mesh), options_(options), is_boundary_(size_t(mesh.num_vertices()), false) {
        for (const TriangleMesh::Edge& edge : mesh.edges()) {
            if (edge.is_boundary()) {
                is_boundary_[size_t(edge.vertices[0])] = is_boundary_[size_t(edge.vertices[1])] = true;
            }
        }
        skin_.positions = positions;
        skin_.directions.resize(3, positions.cols());
        skin_.cosines.resize(positions.cols());
        for (Index v = 0; v < positions.cols(); ++v) {
            update_cone(v);
        }
    }

    RepairedSkin<S> run() {
        for (; skin_.rounds < options_.max_rounds; ++skin_.rounds) {
            std::vector<std::int32_t> moving = vertices_without_cone();
            const std::vector<std::int32_t> sliver = sliver_vertices();
            if (moving.empty() && sliver.empty()) {
                skin_.crossings = crossing_triangles<S>(skin_.positions, mesh_.triangles());
                moving = crossing_vertices();
                if (moving.empty()) {
                    break;
                }
            }
            for (const int start : {options_.first_ring_round, options_.second_ring_round}) {
                if (skin_.rounds >= start) {
                    add_ring(moving);
                }
            }
            moving.insert(moving.end(), sliver.begin(), sliver.end());
            sort_unique(moving);
            move(moving);
        }
        return std::move(skin_);
    }

private:
    std::vector<std::int32_t> vertices_without_cone() const {
        std::vector<std::int32_t> found;
        for (Index v = 0; v < mesh_.num_vertices(); ++v) {
            if (skin_.cosines(v) < options_.wanted_cosine) {
                found.push_back(static_cast<std::int32_t>(v));
            }
        }
        return found;
    }

    std::vector<std::int32_t> sliver_vertices() const {
        std::vector<std::int32_t> found;
        if (skin_.rounds < options_.second_ring_round) {
            const Matrix3X<S> inverse_sines = inverse_corner_sines(skin_.positions, mesh_.triangles());
            for (Index t = 0; t < mesh_.num_triangles(); ++t) {
                if (!(inverse_sines.col(t).maxCoeff() * options_.wanted_sine <= S(1))) {
                    found.insert(found.end(), mesh_.triangles().col(t).begin(), mesh_.triangles().col(t).end());
                }
            }
        }
        return found;
    }

    std::vector<std::int32_t> crossing_vertices() const {
        std::vector<std::int32_t> found;
        for (const auto& [s, t] : skin_.crossings) {
            for (const std::int32_t triangle : {s, t}) {
                found.insert(found.end(), mesh_.triangles().col(triangle).begin(),
                             mesh_.triangles().col(triangle).end());
            }
        }
        sort_unique(found);
        return found;
    }

    void add_ring(std::vector<std::int32_t>& vertices) const {
        const size_t count = vertices.size();
        for (size_t i = 0; i < count; ++i) {
            const auto ring = mesh_.neighbours(vertices[i]);
            vertices.insert(vertices.end(), ring.begin(), ring.end());
        }
        sort_unique(vertices);
    }

    static void sort_unique(std::vector<std::int32_t>& vertices) {
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    }

    void move(std::vector<std::int32_t> vertices) {
        Matrix3X<S> moved(3, static_cast<Index>(vertices.size()));
        for (size_t i = 0; i < vertices.size(); ++i) {
            const std::int32_t v = vertices[i];
            const S share = is_boundary_[size_t(v)] ? S(0) : options_.step;
            moved.col(static_cast<Index>(i)) =
                (S(1) - share) * skin_.positions.col(v) + share * umbrella_mean<S, 3>(mesh_, skin_.positions, v);
        }
        for (size_t i = 0; i < vertices.size(); ++i) {
            skin_.positions.col(vertices[i]) = moved.col(static_cast<Index>(i));
        }
        add_ring(vertices);
        for (const std::int32_t v : vertices) {
            update_cone(v);
        }
    }

    void update_cone(Index v) {
        const auto triangles = mesh_.vertex_triangles(v);
        Triangles around(3, static_cast<Index>(triangles.size()));
        for (size_t k = 0; k < triangles.size(); ++k) {
            around.col(static_cast<Index>(k)) = mesh_.triangles().col(triangles[k]);
        }
        const InwardDirection<S> best = best_inward_direction<S>(triangle_normals<S>(skin_.positions, around));
        skin_.directions.col(v) = best.direction;
        skin_.cosines(v) = best.cosine;
    }

    const TriangleMesh& mesh_;
    SkinRepairOptions<S> options_;
    std::vector<bool> is_boundary_;
    RepairedSkin<S> skin_;
};

}  // namespace detail

/// See the file comment.
template <RealScalar S>
RepairedSkin<S> repair_skin(const TriangleMesh& mesh, const Matrix3X<S>& positions,
                            const SkinRepairOptions<S>& options = {}) {
    return detail::SkinRepair<S>(mesh, positions, options).run();
}

}  // namespace softtissue
