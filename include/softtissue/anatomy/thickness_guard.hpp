// SPDX-License-Identifier: MIT
/// @file
/// The largest thickness up to a wanted one for which a layer is valid.
///
/// What        guarded_thickness(): reduces the thickness around invalid cells, gives back what was taken too much, and
///             reduces it where the inner surface crosses itself or the skin.
/// Method      1. While a triangle's relative_jacobian is below the margin: its vertices lose a share of their thickness, and
///                around reduced vertices the thickness may rise by at most max_slope per metre along edges.
///             2. Vertex by vertex, reduced ones grow again while their triangles stay above the margin.
///             3. As 1. for crossing triangles, except where the skin itself crosses.
///             Step 1 ends because the measure tends to one with the thickness, if all directions lie in their cones.
/// Tests       tests/unit/anatomy/thickness_guard_test.cpp
#pragma once

#include <softtissue/anatomy/layer_validity.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct GuardedThickness {
    VectorX<S> thickness;
    int rounds = 0;
    /// Pairs of crossing triangles of the inner surface, or of it and the skin, that are left (the skin crosses there too).
    Index crossings_left = 0;
};

template <RealScalar S>
class ThicknessGuard {
public:
    static constexpr S reduction = S(0.85);
    static constexpr S max_slope = S(0.5);

    ThicknessGuard(const TriangleMesh& mesh, const LayerColumns<S>& columns, S margin)
        : mesh_(mesh), columns_(columns), margin_(margin) {}

    GuardedThickness<S> reduce(const VectorX<S>& wanted) const {
        GuardedThickness<S> result{wanted};
        reduce_until_valid(result);
        for (int sweep = 0; sweep < regrowth_sweeps; ++sweep) {
            regrow(wanted, result.thickness);
        }
        for (int round = 0;; ++round) {
            const std::vector<std::int32_t> crossing = crossing_columns(result.thickness, result.crossings_left);
            if (crossing.empty() || round == max_crossing_rounds) {
                break;
            }
            take_away(crossing, result);
            reduce_until_valid(result);
        }
        return result;
    }

    bool is_valid(Index triangle, const VectorX<S>& thickness) const {
        return relative_jacobian<S>(columns_, mesh_.triangles().col(triangle), thickness) >= margin_;
    }

private:
    static constexpr int regrowth_sweeps = 10;
    static constexpr int max_crossing_rounds = 30;

    void reduce_until_valid(GuardedThickness<S>& result) const {
        // The smallest normal number divided out of any thickness: a backstop, the measure reaches one long before.
        constexpr int max_rounds = 400;
        for (int round = 0; round < max_rounds; ++round) {
            std::vector<std::int32_t> marked;
            for (Index t = 0; t < mesh_.num_triangles(); ++t) {
                if (!is_valid(t, result.thickness)) {
                    marked.insert(marked.end(), mesh_.triangles().col(t).begin(), mesh_.triangles().col(t).end());
                }
            }
            if (marked.empty()) {
                return;
            }
            take_away(std::move(marked), result);
        }
    }

    /// One reduction of the marked columns, and the slope limit around them.
    void take_away(std::vector<std::int32_t> marked, GuardedThickness<S>& result) const {
        std::sort(marked.begin(), marked.end());
        marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
        using Entry = std::pair<S, std::int32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        VectorX<S>& h = result.thickness;
        for (const std::int32_t v : marked) {
            h(v) *= reduction;
            queue.emplace(h(v), v);
        }
        while (!queue.empty()) {
            const auto [value, v] = queue.top();
            queue.pop();
            if (value > h(v)) {
                continue;
            }
            for (const std::int32_t w : mesh_.neighbours(v)) {
                const S limit = value + max_slope * edge_length(v, w);
                if (limit < h(w)) {
                    h(w) = limit;
                    queue.emplace(limit, w);
                }
            }
        }
        ++result.rounds;
    }

    /// One sweep in ascending order over the columns thinner than wanted.
    void regrow(const VectorX<S>& wanted, VectorX<S>& h) const {
        for (Index v = 0; v < h.size(); ++v) {
            if (!(h(v) < wanted(v))) {
                continue;
            }
            const S before = h(v);
            S grown = std::min(wanted(v), before / reduction);
            for (const std::int32_t w : mesh_.neighbours(v)) {
                grown = std::min(grown, h(w) + max_slope * edge_length(static_cast<std::int32_t>(v), w));
            }
            h(v) = std::max(before, grown);
            const auto triangles = mesh_.vertex_triangles(v);
            if (!std::all_of(triangles.begin(), triangles.end(), [&](std::int32_t t) { return is_valid(t, h); })) {
                h(v) = before;
            }
        }
    }

    /// The columns of inner triangles that cross another inner or a skin triangle, where the skin does not cross itself.
    std::vector<std::int32_t> crossing_columns(const VectorX<S>& h, Index& crossings_left) const {
        const Index n = mesh_.num_vertices();
        const Index m = mesh_.num_triangles();
        Matrix3X<S> positions(3, 2 * n);
        positions << columns_.skin_positions, columns_.skin_positions + columns_.directions * h.asDiagonal();
        Triangles triangles(3, 2 * m);
        triangles << mesh_.triangles(), (mesh_.triangles().array() + static_cast<std::int32_t>(n)).matrix();
        const auto pairs = crossing_triangles<S>(positions, triangles);
        std::vector<std::pair<std::int32_t, std::int32_t>> skin_pairs;
        std::vector<std::int32_t> marked;
        crossings_left = 0;
        for (const auto& [s, t] : pairs) {
            if (t < m) {
                skin_pairs.emplace_back(s, t);
            }
        }
        for (const auto& [s, t] : pairs) {
            if (t < m) {
                continue;
            }
            ++crossings_left;
            const std::pair<std::int32_t, std::int32_t> below =
                std::minmax({static_cast<std::int32_t>(s % m), static_cast<std::int32_t>(t % m)});
            if (std::binary_search(skin_pairs.begin(), skin_pairs.end(), below)) {
                continue;
            }
            for (const std::int32_t triangle : {s, t}) {
                if (triangle >= m) {  // an inner one: thinner columns move it
                    marked.insert(marked.end(), mesh_.triangles().col(triangle - m).begin(),
                                  mesh_.triangles().col(triangle - m).end());
                }
            }
        }
        return marked;
    }

    S edge_length(std::int32_t v, std::int32_t w) const {
        return (columns_.skin_positions.col(v) - columns_.skin_positions.col(w)).norm();
    }

    const TriangleMesh& mesh_;
    const LayerColumns<S>& columns_;
    S margin_;
};

}  // namespace softtissue
