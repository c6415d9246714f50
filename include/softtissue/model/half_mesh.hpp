// SPDX-License-Identifier: MIT
/// @file
/// A triangle mesh that can be edited edge by edge: half of a mirror-symmetric surface, bounded by the mirror plane.
///
/// What        split, collapse and flip of an edge, with the conditions under which they keep a manifold;
///             the triangles around each vertex are at hand.
/// Shapes      as SurfaceMesh; erased triangles hold -1, erased vertices have no triangle, until compacted().
/// Valid       manifold, consistently oriented input whose boundary, if any, is where the mirror image joins:
///             no edit creates an inner edge between two boundary vertices, so the mirrored whole is manifold too.
/// Tests       tests/unit/model/half_mesh_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/surface_mesh.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace softtissue {

class HalfMesh {
public:
    using Triangle = std::array<int, 3>;

    explicit HalfMesh(SurfaceMesh mesh)
        : mesh_(std::move(mesh)), star_(mesh_.vertices.size()), on_boundary_(mesh_.vertices.size(), false) {
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
            for (const int v : mesh_.triangles[t]) {
                star_[size_t(v)].push_back(int(t));
            }
        }
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
            for (size_t k = 0; k < 3; ++k) {
                const auto [a, b] = edge(t, k);
                if (triangle_with(b, a) < 0) {
                    on_boundary_[size_t(a)] = on_boundary_[size_t(b)] = true;
                }
            }
        }
    }

    int num_vertices() const { return int(mesh_.vertices.size()); }
    size_t num_triangles() const { return mesh_.triangles.size(); }
    const Vector3<double>& position(int v) const { return mesh_.vertices[size_t(v)]; }
    Vector3<double>& position(int v) { return mesh_.vertices[size_t(v)]; }
    const Triangle& triangle(int t) const { return mesh_.triangles[size_t(t)]; }
    const std::vector<int>& star(int v) const { return star_[size_t(v)]; }
    bool is_erased(size_t t) const { return mesh_.triangles[t][0] < 0; }
    bool is_on_boundary(int v) const { return on_boundary_[size_t(v)]; }
    bool is_boundary_edge(int a, int b) const { return triangle_with(a, b) < 0 || triangle_with(b, a) < 0; }
    double length(int a, int b) const { return (position(a) - position(b)).norm(); }
    Vector3<double> normal(int t) const { return mesh_.normal(size_t(t)); }

    /// Corners k and k + 1 of triangle t.
    std::pair<int, int> edge(size_t t, size_t k) const {
        return {mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]};
    }

    int opposite(int t, int a, int b) const {
        const Triangle& v = triangle(t);
        return v[0] + v[1] + v[2] - a - b;
    }

    /// The triangle that runs from a to b, or -1.
    int triangle_with(int a, int b) const {
        for (const int t : star_[size_t(a)]) {
            for (size_t k = 0; k < 3; ++k) {
                if (edge(size_t(t), k) == std::pair(a, b)) {
                    return t;
                }
            }
        }
        return -1;
    }

    std::vector<int> neighbours(int v) const {
        std::vector<int> result;
        for (const int t : star_[size_t(v)]) {
            for (const int w : triangle(t)) {
                if (w != v) {
                    result.push_back(w);
                }
            }
        }
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    /// Puts a vertex on the middle of edge a-b of triangle t; returns it.
    int split(int a, int b, int t) {
        const int other = triangle_with(b, a);
        const int m = num_vertices();
        mesh_.vertices.push_back(0.5 * (position(a) + position(b)));
        star_.emplace_back();
        on_boundary_.push_back(other < 0);
        for (const int side : {t, other}) {
            if (side >= 0) {
                const int near = side == t ? a : b;
                const int far = side == t ? b : a;
                Triangle added = triangle(side);
                std::replace(added.begin(), added.end(), near, m);
                replace(side, far, m);
                for (const int v : added) {
                    star_[size_t(v)].push_back(int(mesh_.triangles.size()));
                }
                mesh_.triangles.push_back(added);
            }
        }
        return m;
    }

    /// True when merging b into a leaves a manifold; a must be the one on the boundary if only one is.
    bool can_collapse(int a, int b) const {
        const std::vector<int> of_a = neighbours(a);
        const std::vector<int> of_b = neighbours(b);
        std::vector<int> common;
        std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
        const bool is_boundary = is_boundary_edge(a, b);
        if (common.size() != (is_boundary ? 1u : 2u)) {
            return false;
        }
        const auto is_too_small = [this](int c) { return star(c).size() <= (is_on_boundary(c) ? 2u : 3u); };
        if (std::any_of(common.begin(), common.end(), is_too_small)) {
            return false;
        }
        const auto would_join_boundary = [&](int n) {
            return n != a && is_on_boundary(n) && !std::binary_search(common.begin(), common.end(), n);
        };
        return is_boundary || !is_on_boundary(a) || std::none_of(of_b.begin(), of_b.end(), would_join_boundary);
    }

    /// Merges b into a, which keeps its position.
    void collapse(int a, int b) {
        const std::vector<int> around = star(b);
        for (const int t : around) {
            const Triangle v = triangle(t);
            if (v[0] == a || v[1] == a || v[2] == a) {
                for (const int w : v) {
                    leave(w, t);
                }
                mesh_.triangles[size_t(t)] = {-1, -1, -1};
            } else {
                replace(t, b, a);
            }
        }
    }

    /// True when the inner edge between triangles t and `other` may be turned to join their far corners c and d.
    bool can_flip(int c, int d) const {
        return !(is_on_boundary(c) && is_on_boundary(d)) && triangle_with(c, d) < 0 && triangle_with(d, c) < 0;
    }

    /// Turns edge a-b: triangles t = (a, b, c) and other = (b, a, d) become (a, d, c) and (b, c, d).
    void flip(int t, int other, int a, int b, int c, int d) {
        replace(t, b, d);
        replace(other, a, c);
    }

    /// The mesh without erased vertices and triangles, in the same order.
    SurfaceMesh compacted() const {
        SurfaceMesh result;
        std::vector<int> number(mesh_.vertices.size(), -1);
        for (size_t v = 0; v < mesh_.vertices.size(); ++v) {
            if (!star_[v].empty()) {
                number[v] = int(result.vertices.size());
                result.vertices.push_back(mesh_.vertices[v]);
            }
        }
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (!is_erased(t)) {
                const Triangle& v = mesh_.triangles[t];
                result.triangles.push_back({number[size_t(v[0])], number[size_t(v[1])], number[size_t(v[2])]});
            }
        }
        return result;
    }

private:
    void leave(int v, int t) {
        std::vector<int>& around = star_[size_t(v)];
        around.erase(std::find(around.begin(), around.end(), t));
    }

    void replace(int t, int from, int to) {
        Triangle& v = mesh_.triangles[size_t(t)];
        std::replace(v.begin(), v.end(), from, to);
        leave(from, t);
        star_[size_t(to)].push_back(t);
    }

    SurfaceMesh mesh_;
    std::vector<std::vector<int>> star_;  // triangles around each vertex
    std::vector<bool> on_boundary_;
};

}  // namespace softtissue
