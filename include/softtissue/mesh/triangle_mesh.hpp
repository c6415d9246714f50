// SPDX-License-Identifier: MIT
/// @file
/// The connectivity of an oriented triangle surface, closed or with boundary.
///
/// What        edges with their one or two triangles, triangles and neighbours of each vertex, boundary loops.
/// Shapes      triangles 3 x m, counter-clockwise seen from outside; vertices 0 .. num_vertices - 1.
/// Refuses     an index out of range, a vertex twice in a triangle, an edge of more than two triangles, two triangles that
///             run through an edge in the same direction, a boundary that passes a vertex twice (InvalidInput names
///             triangle, edge or vertex; the last one in boundary_loops() only).
/// Cost        one sort of the 3 m half-edges.
/// Tests       tests/unit/mesh/triangle_mesh_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/adjacency.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

class TriangleMesh {
public:
    static constexpr std::int32_t no_triangle = -1;

    /// Two vertices and the triangles on both sides.
    struct Edge {
        /// In the direction in which triangles[0] runs through it.
        std::array<std::int32_t, 2> vertices;
        /// triangles[1] is no_triangle on the boundary.
        std::array<std::int32_t, 2> triangles;

        bool is_boundary() const { return triangles[1] == no_triangle; }
    };

    /// `source` (a file or surface name) starts the message of a refusal.
    TriangleMesh(Triangles triangles, Index num_vertices, const std::string& source = "surface")
        : triangles_(std::move(triangles)), num_vertices_(checked_index(num_vertices, source, ": vertices")) {
        checked_index(3 * num_triangles(), source, ": corners of triangles");
        check_indices(source);
        build_edges(source);
        build_adjacency();
    }

    Index num_vertices() const { return num_vertices_; }
    Index num_triangles() const { return triangles_.cols(); }
    const Triangles& triangles() const { return triangles_; }

    /// Ascending by (smaller vertex, larger vertex).
    const std::vector<Edge>& edges() const { return edges_; }

    /// The triangles at `vertex`, ascending.
    std::span<const std::int32_t> vertex_triangles(Index vertex) const { return vertex_triangles_.row(vertex); }

    /// The vertices that share an edge with `vertex`, ascending.
    std::span<const std::int32_t> neighbours(Index vertex) const { return neighbours_.row(vertex); }

    bool is_closed() const {
        return std::none_of(edges_.begin(), edges_.end(), [](const Edge& edge) { return edge.is_boundary(); });
    }

    /// Vertices - edges + triangles; 2 for a sphere.
    Index euler_characteristic() const { return num_vertices() - static_cast<Index>(edges_.size()) + num_triangles(); }

    /// Each loop starts at its smallest vertex and runs with its triangles (the surface on the left, seen from outside);
    /// loops ascend by their first vertex.
    std::vector<std::vector<std::int32_t>> boundary_loops() const {
        std::vector<std::int32_t> next(size_t(num_vertices_), -1);
        for (const Edge& edge : edges_) {
            if (edge.is_boundary()) {
                const auto [from, to] = edge.vertices;
                require(next[size_t(from)] < 0, "surface: the boundary passes vertex ", from,
                        " more than once, expected simple loops");
                next[size_t(from)] = to;
            }
        }
        std::vector<std::vector<std::int32_t>> loops;
        for (size_t start = 0; start < next.size(); ++start) {
            if (next[start] < 0) {
                continue;
            }
            loops.emplace_back();
            for (auto v = static_cast<std::int32_t>(start); next[size_t(v)] >= 0;) {
                loops.back().push_back(v);
                v = std::exchange(next[size_t(v)], -1);
            }
        }
        return loops;
    }

private:
    struct HalfEdge {
        std::int32_t low, high, triangle;
        bool ascending;
    };

    void check_indices(const std::string& source) const {
        for (Index t = 0; t < num_triangles(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const std::int32_t v = triangles_(k, t);
                require(v >= 0 && v < num_vertices_, source, ": triangle ", t, " uses vertex ", v, ", expected 0 to ",
                        num_vertices_ - 1);
                require(v != triangles_((k + 1) % 3, t), source, ": triangle ", t, " uses vertex ", v, " twice");
            }
        }
    }

    void build_edges(const std::string& source) {
        std::vector<HalfEdge> half_edges;
        half_edges.reserve(size_t(3 * num_triangles()));
        for (Index t = 0; t < num_triangles(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const std::int32_t a = triangles_(k, t);
                const std::int32_t b = triangles_((k + 1) % 3, t);
                half_edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
            }
        }
        std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
            return std::array{x.low, x.high, x.triangle} < std::array{y.low, y.high, y.triangle};
        });
        for (const HalfEdge& h : half_edges) {
            const bool is_second =
                !edges_.empty() &&
                std::minmax({edges_.back().vertices[0], edges_.back().vertices[1]}) == std::pair(h.low, h.high);
            if (!is_second) {
                edges_.push_back(
                    {h.ascending ? std::array{h.low, h.high} : std::array{h.high, h.low}, {h.triangle, no_triangle}});
                continue;
            }
            Edge& edge = edges_.back();
            require(edge.is_boundary(), source, ": edge (", h.low, ", ", h.high, ") belongs to triangles ",
                    edge.triangles[0], ", ", edge.triangles[1], " and ", h.triangle, ", expected at most two");
            require(h.ascending != (edge.vertices[0] == h.low), source, ": triangles ", edge.triangles[0], " and ",
                    h.triangle, " run through edge (", h.low, ", ", h.high,
                    ") in the same direction, expected consistent orientation");
            edge.triangles[1] = h.triangle;
        }
    }

    void build_adjacency() {
        std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
        for (Index t = 0; t < num_triangles(); ++t) {
            for (int k = 0; k < 3; ++k) {
                pairs.emplace_back(triangles_(k, t), static_cast<std::int32_t>(t));
            }
        }
        vertex_triangles_ = Adjacency(num_vertices_, pairs);
        pairs.clear();
        for (const Edge& edge : edges_) {
            pairs.emplace_back(edge.vertices[0], edge.vertices[1]);
            pairs.emplace_back(edge.vertices[1], edge.vertices[0]);
        }
        std::sort(pairs.begin(), pairs.end());
        neighbours_ = Adjacency(num_vertices_, pairs);
    }

    Triangles triangles_;
    Index num_vertices_;
    std::vector<Edge> edges_;
    Adjacency vertex_triangles_;
    Adjacency neighbours_;
};

}  // namespace softtissue
