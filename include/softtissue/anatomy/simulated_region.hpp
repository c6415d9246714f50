// SPDX-License-Identifier: MIT
/// @file
/// The part of a skinned body that is simulated: the skin without its extremities.
///
/// What        a connected piece of the skin with simple boundary loops ("cuts"), numbered anew, with maps to the body and
///             the distance of each vertex to the cuts.
/// Rule        A vertex belongs to an extremity if its weights for one group of joints sum to more than weight_threshold.
///             Triangles with three remaining vertices are kept, of these the largest piece; triangles with two or more
///             boundary edges, and those around a vertex that the boundary passes twice, are dropped until none is left.
/// Parameters  RegionOptions::extremities: groups of joints; unset = head, wrists + hands, ankles + feet of SMPL, SMPL-H or SMPL-X;
///             an empty list keeps the whole body. excluded_vertices: body vertices to leave out besides.
/// Refuses     a body of another number of joints without extremities named, a joint or vertex out of range, nothing left.
/// Source      Romero et al. 2020, section 3.2 (extremities removed).
/// Tests       tests/unit/anatomy/simulated_region_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/edge_distance.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

namespace softtissue {

using JointGroups = std::vector<std::vector<std::int32_t>>;

/// Head; ankles and feet; wrists and hands, in the order of SMPL (24 joints), SMPL-H (52) or SMPL-X (55).
inline JointGroups smpl_extremities(Index num_joints = 24) {
    require(
        num_joints == 24 || num_joints == 52 || num_joints == 55, "simulated region: the body has ", num_joints,
        " joints, expected SMPL's 24 (SMPL-H: 52, SMPL-X: 55), or the joints of its extremities named in the options");
    JointGroups groups = {{15}, {7, 8, 10, 11}, {20, 21}};
    std::int32_t first_of_hands = 22;
    for (; num_joints == 55 && first_of_hands < 25; ++first_of_hands) {
        groups[0].push_back(first_of_hands);  // jaw and eyes
    }
    for (std::int32_t joint = first_of_hands; joint < num_joints; ++joint) {
        groups[2].push_back(joint);
    }
    return groups;
}

struct RegionOptions {
    std::optional<JointGroups> extremities = {};
    double weight_threshold = 0.5;
    std::vector<std::int32_t> excluded_vertices = {};
};

template <RealScalar S>
struct SimulatedRegion {
    Triangles triangles;                           // 3 x m, region vertices
    std::vector<std::int32_t> body_triangles;      // m: triangle of the body
    std::vector<std::int32_t> body_vertices;       // n: region vertex -> body vertex, ascending
    std::vector<std::int32_t> region_vertices;     // one per body vertex: region vertex, or -1
    std::vector<std::vector<std::int32_t>> loops;  // the cuts, region vertices
    VectorX<S> cut_distance;                       // n [m], along edges; infinity without a cut

    Index num_vertices() const { return static_cast<Index>(body_vertices.size()); }
    Index num_triangles() const { return triangles.cols(); }

    /// Whether `vertex` (of the region) lies on a cut.
    bool is_rim(Index vertex) const { return cut_distance(vertex) == S(0); }

    /// 0 on a cut, rising smoothly (as 3 s^2 - 2 s^3) to 1 at `distance` from it.
    S fade(Index vertex, S distance) const {
        const S s = std::min(cut_distance(vertex) / distance, S(1));
        return s * s * (S(3) - S(2) * s);
    }

    /// The columns of a per-body-vertex array that belong to the region.
    Matrix3X<S> gather(const Matrix3X<S>& body_values) const {
        Matrix3X<S> values(3, num_vertices());
        for (Index v = 0; v < num_vertices(); ++v) {
            values.col(v) = body_values.col(body_vertices[size_t(v)]);
        }
        return values;
    }
};

namespace detail {

template <RealScalar S>
std::vector<bool> vertices_outside_extremities(const SkinningWeights<S>& weights, const RegionOptions& options) {
    const JointGroups groups = options.extremities ? *options.extremities : smpl_extremities(weights.num_joints());
    std::vector<bool> kept(size_t(weights.num_vertices()), true);
    for (const std::vector<std::int32_t>& group : groups) {
        std::vector<bool> in_group(size_t(weights.num_joints()), false);
        for (const std::int32_t joint : group) {
            require(joint >= 0 && joint < weights.num_joints(), "simulated region: extremity joint ", joint,
                    ", expected 0 to ", weights.num_joints() - 1);
            in_group[size_t(joint)] = true;
        }
        for (Index v = 0; v < weights.num_vertices(); ++v) {
            double sum = 0;
            for (const auto& [joint, weight] : weights.row(v)) {
                sum += in_group[size_t(joint)] ? double(weight) : 0.0;
            }
            kept[size_t(v)] = kept[size_t(v)] && sum <= options.weight_threshold;
        }
    }
    for (const std::int32_t v : options.excluded_vertices) {
        require(v >= 0 && v < weights.num_vertices(), "simulated region: excluded vertex ", v, ", expected 0 to ",
                weights.num_vertices() - 1);
        kept[size_t(v)] = false;
    }
    return kept;
}

/// Unsets all but the largest edge-connected piece of the kept triangles (the first of equals).
inline void keep_largest_piece(const TriangleMesh& body, std::vector<bool>& kept) {
    std::vector<std::int32_t> piece(kept.size());
    std::iota(piece.begin(), piece.end(), 0);
    const auto find = [&piece](std::int32_t t) {
        while (piece[size_t(t)] != t) {
            t = piece[size_t(t)] = piece[size_t(piece[size_t(t)])];
        }
        return t;
    };
    for (const TriangleMesh::Edge& edge : body.edges()) {
        const auto [t0, t1] = edge.triangles;
        if (!edge.is_boundary() && kept[size_t(t0)] && kept[size_t(t1)]) {
            const auto [low, high] = std::minmax({find(t0), find(t1)});
            piece[size_t(high)] = low;
        }
    }
    std::vector<Index> sizes(kept.size(), 0);
    for (size_t t = 0; t < kept.size(); ++t) {
        sizes[size_t(find(static_cast<std::int32_t>(t)))] += kept[t] ? 1 : 0;
    }
    const auto largest = static_cast<std::int32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (size_t t = 0; t < kept.size(); ++t) {
        kept[t] = kept[t] && find(static_cast<std::int32_t>(t)) == largest;
    }
}

/// Unsets the kept triangles with two or more boundary edges and those around pinched vertices; true if there were any.
inline bool drop_ears(const TriangleMesh& body, std::vector<bool>& kept) {
    std::vector<int> boundary_edges(kept.size(), 0);
    std::vector<int> passes(size_t(body.num_vertices()), 0);
    for (const TriangleMesh::Edge& edge : body.edges()) {
        const auto [t0, t1] = edge.triangles;
        const bool kept0 = kept[size_t(t0)];
        const bool kept1 = !edge.is_boundary() && kept[size_t(t1)];
        if (kept0 != kept1) {
            ++boundary_edges[size_t(kept0 ? t0 : t1)];
            ++passes[size_t(edge.vertices[0])];
            ++passes[size_t(edge.vertices[1])];
        }
    }
    bool dropped = false;
    for (size_t t = 0; t < kept.size(); ++t) {
        if (!kept[t]) {
            continue;
        }
        bool is_pinched = false;
        for (const std::int32_t v : body.triangles().col(static_cast<Index>(t))) {
            is_pinched = is_pinched || passes[size_t(v)] > 2;
        }
        if (is_pinched || boundary_edges[t] >= 2) {
            kept[t] = false;
            dropped = true;
        }
    }
    return dropped;
}

}  // namespace detail

/// The simulated region of a body with skin `positions` (3 x n) and connectivity `body`.
template <RealScalar S>
SimulatedRegion<S> make_simulated_region(const Matrix3X<S>& positions, const TriangleMesh& body,
                                         const SkinningWeights<S>& weights, const RegionOptions& options = {}) {
    require(weights.num_vertices() == positions.cols() && body.num_vertices() == positions.cols(),
            "simulated region: ", positions.cols(), " positions, ", body.num_vertices(), " mesh vertices, ",
            weights.num_vertices(), " rows of weights, expected equal numbers");
    const std::vector<bool> vertex_kept = detail::vertices_outside_extremities(weights, options);
    std::vector<bool> kept(size_t(body.num_triangles()), true);
    for (Index t = 0; t < body.num_triangles(); ++t) {
        for (const std::int32_t v : body.triangles().col(t)) {
            kept[size_t(t)] = kept[size_t(t)] && vertex_kept[size_t(v)];
        }
    }
    do {
        detail::keep_largest_piece(body, kept);
    } while (detail::drop_ears(body, kept));

    SimulatedRegion<S> region;
    region.region_vertices.assign(size_t(body.num_vertices()), -1);
    for (size_t t = 0; t < kept.size(); ++t) {
        if (kept[t]) {
            region.body_triangles.push_back(static_cast<std::int32_t>(t));
            for (const std::int32_t v : body.triangles().col(static_cast<Index>(t))) {
                region.region_vertices[size_t(v)] = 0;
            }
        }
    }
    require(!region.body_triangles.empty(),
            "simulated region: no triangle left, expected skin outside the extremities");
    for (size_t v = 0; v < region.region_vertices.size(); ++v) {
        if (region.region_vertices[v] == 0) {
            region.region_vertices[v] = static_cast<std::int32_t>(region.body_vertices.size());
            region.body_vertices.push_back(static_cast<std::int32_t>(v));
        }
    }
    region.triangles.resize(3, static_cast<Index>(region.body_triangles.size()));
    for (Index t = 0; t < region.num_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) {
            region.triangles(k, t) =
                region.region_vertices[size_t(body.triangles()(k, region.body_triangles[size_t(t)]))];
        }
    }
    const TriangleMesh mesh(region.triangles, region.num_vertices(), "simulated region");
    region.loops = mesh.boundary_loops();
    std::vector<std::int32_t> rim;
    for (const std::vector<std::int32_t>& loop : region.loops) {
        rim.insert(rim.end(), loop.begin(), loop.end());
    }
    region.cut_distance = edge_distances<S>(mesh, region.gather(positions), rim);
    return region;
}

}  // namespace softtissue
