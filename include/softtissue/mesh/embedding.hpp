// SPDX-License-Identifier: MIT
/// @file
/// Points that ride on the cells of a volume mesh: high-resolution anatomy in a simulation mesh.
///
/// What        each point gets a cell and up to six node weights once; a frame is one gather.
/// Equation    p -> sum_i w_i x_i,  w_i = N_i(xi) + g_i . (p - X(xi)): the cell's shape functions at xi plus the offset
///             from there, carried by the cell's gradient F = sum_i x_i g_i^T.
/// Outside     A point in a cell has no offset. One in no cell goes to the nearest, xi its closest point: what it
///             does is continuous as the point leaves the cell, and linear in the offset. It may jump where the nearest
///             cell changes, by |offset| times the difference of the two F.
/// Shapes      points 3 x n, x and rest positions 3 x vertices [m]; indices and weights 6 x n, a tet's last two
///             weights 0. Several meshes number their vertices alike: the shorter array of rest positions is the beginning
///             of the longer; cells are numbered through, those of the first mesh first.
/// Valid       affine motions of the vertices move all points alike, those outside included; weights sum to 1 and are >= 0
///             inside. Far outside a thin cell they grow like distance over thickness: report() has the largest distance.
/// Refuses     points that are not finite, a mesh that CellMesh::validate() refuses, meshes whose rest positions differ or
///             without any cell (InvalidInput); apply_into() asserts its sizes.
/// Source      Nolte et al. 2026, sec. 3.3
/// Cost        apply_into(): 36 flop a point, bound by reading 12 numbers of it (72 bytes in double, 48 in float)
/// Tests       tests/unit/mesh/embedding_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_shuffle.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/closest_point_in_cell.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

/// How well the points fit into the cells.
template <RealScalar S>
struct EmbeddingReport {
    Index num_outside = 0;      ///< points farther from all cells than rounding explains
    S largest_distance = S(0);  ///< [m]
    Index farthest_point = -1;  ///< -1 if none is outside
};

template <RealScalar S>
class Embedding {
public:
    using Scalar = S;
    static constexpr int width = 6;
    using Indices = Eigen::Matrix<std::int32_t, width, Eigen::Dynamic>;
    using Weights = Eigen::Matrix<S, width, Eigen::Dynamic>;

    Embedding() = default;

    /// In tets or prisms.
    template <class ElementType, Executor Exec = SequentialExecutor>
    Embedding(ConstRef<Matrix3X<S>> points, const CellMesh<ElementType, S>& mesh, const Exec& executor = {}) {
        check_points(points);
        mesh.validate();
        embed(points, executor, mesh);
    }

    /// In prisms and the tets that fill what they enclose.
    template <Executor Exec = SequentialExecutor>
    Embedding(ConstRef<Matrix3X<S>> points, const CellMesh<Prism6, S>& prisms, const CellMesh<Tet4, S>& tets,
              const Exec& executor = {}) {
        check_points(points);
        prisms.validate();
        tets.validate();
        const Index common = std::min(prisms.num_vertices(), tets.num_vertices());
        for (Index v = 0; v < common; ++v) {
            require(prisms.rest_positions.col(v) == tets.rest_positions.col(v), "embedding: vertex ", v,
                    " of the prisms and of the tets differ by ",
                    (prisms.rest_positions.col(v) - tets.rest_positions.col(v)).norm(),
                    " m, expected one common numbering");
        }
        embed(points, executor, prisms, tets);
    }

    Index num_points() const { return indices_.cols(); }

    /// One more than the largest index.
    Index num_vertices() const { return num_vertices_; }
    const Indices& indices() const { return indices_; }
    const Weights& weights() const { return weights_; }

    /// The cell of each point.
    const std::vector<std::int32_t>& cells() const { return cells_; }

    /// From each point to its cell at rest [m]; 0 inside.
    const VectorX<S>& distances() const { return distances_; }
    const EmbeddingReport<S>& report() const { return report_; }

    /// The points at the vertex positions `x`, 3 x vertices, into `out`, 3 x points.
    template <Executor Exec = SequentialExecutor>
    void apply_into(ConstRef<Matrix3X<S>> x, Eigen::Ref<Matrix3X<S>> out, const Exec& executor = {}) const {
        SOFTTISSUE_ASSERT(x.cols() >= num_vertices_ && out.cols() == num_points());
        const bool is_dense = x.outerStride() == 3 && out.outerStride() == 3;
        executor.for_each_range(num_points(), [&](Index begin, Index end) {
            const S* const from = x.data();
            S* const to = out.data();
            auto careful = std::lower_bound(at_last_vertex_.begin(), at_last_vertex_.end(), begin);
            for (Index p = begin; p < end; ++p) {
                // Four numbers at a time, of which the fourth is the next column's; where there may be no next one, three.
                const Index next = careful != at_last_vertex_.end() ? *careful : end;
                const Index stop = is_dense ? std::min(next, end - 1) : p;
                if constexpr (natural_lanes<S> >= 16) {
                    for (; p + 2 < stop; p += 2) {
                        const Eight pair = positions_of_pair(p, from, std::make_integer_sequence<int, width>());
                        chosen<0, 1, 2, 3>(pair).store(to + 3 * p);
                        chosen<4, 5, 6, 7>(pair).store(to + 3 * p + 3);
                    }
                }
                for (; p < stop; ++p) {
                    position(p, [from](Index v) { return Four::load(from + 3 * v); }).store(to + 3 * p);
                }
                const Four sum = position(
                    p, [&](std::int32_t v) { return Four::from_lanes([&](int d) { return d < 3 ? x(d, v) : S(0); }); });
                out.col(p) << sum[0], sum[1], sum[2];
                careful += p == next ? 1 : 0;
            }
        });
    }

    /// The same embedding with weights in another precision: found in double, applied in float.
    template <RealScalar T>
    Embedding<T> cast() const {
        Embedding<T> result;
        result.num_vertices_ = num_vertices_;
        result.indices_ = indices_;
        result.weights_ = weights_.template cast<T>();
        result.at_last_vertex_ = at_last_vertex_;
        result.cells_ = cells_;
        result.distances_ = distances_.template cast<T>();
        result.report_ = {report_.num_outside, static_cast<T>(report_.largest_distance), report_.farthest_point};
        return result;
    }

private:
    using Four = Pack<S, 4>;
    using Eight = Pack<S, 8>;

    /// Of points p and p + 1, a half of the lanes each, rounded as position() does; reads four weights more.
    template <int... i>
    [[gnu::always_inline]] inline Eight positions_of_pair(Index p, const S* from,
                                                          std::integer_sequence<int, i...>) const {
        const std::int32_t* const v = indices_.data() + width * p;
        const auto w = Pack<S, 16>::load(weights_.data() + width * p);
        const auto at = [&](int k) { return Four::load(from + 3 * Index(v[k])); };
        Eight sum(0);
        ((sum += chosen<i, i, i, i, width + i, width + i, width + i, width + i>(w) * joined(at(i), at(width + i))),
         ...);
        return sum;
    }

    /// Of a point; at(v) are the coordinates of a vertex.
    template <class At>
    [[gnu::always_inline]] inline Four position(Index p, const At& at) const {
        const std::int32_t* const v = indices_.data() + width * p;
        const S* const w = weights_.data() + width * p;
        Four sum(0);
        for (int i = 0; i < width; ++i) {
            sum += Four(w[i]) * at(v[i]);
        }
        return sum;
    }

    template <RealScalar T>
    friend class Embedding;

    static void check_points(ConstRef<Matrix3X<S>> points) {
        for (Index p = 0; p < points.cols(); ++p) {
            require(points.col(p).allFinite(), "embedding: point ", p, " is not finite");
        }
    }

    /// visit(mesh, cell of that mesh) for a cell of the common numbering.
    template <class Visit, class Mesh, class... Meshes>
    static void visit_cell(Index cell, const Visit& visit, const Mesh& mesh, const Meshes&... meshes) {
        if (cell < mesh.num_cells()) {
            visit(mesh, cell);
        } else if constexpr (sizeof...(Meshes) > 0) {
            visit_cell(cell - mesh.num_cells(), visit, meshes...);
        }
    }

    template <class Exec, class... Meshes>
    void embed(ConstRef<Matrix3X<S>> points, const Exec& executor, const Meshes&... meshes) {
        num_vertices_ = std::max({meshes.num_vertices()...});
        const Index num_cells = (meshes.num_cells() + ...);
        require(num_cells > 0, "embedding: the mesh has no cells");
        std::vector<Box<S>> boxes(static_cast<std::size_t>(num_cells));
        for (Index c = 0; c < num_cells; ++c) {
            const auto fit = [&](const auto& mesh, Index cell) {
                for (int i = 0; i < mesh.num_nodes; ++i) {
                    boxes[size_t(c)].extend(mesh.rest_positions.col(mesh.cells(i, cell)));
                }
            };
            visit_cell(c, fit, meshes...);
        }
        const BoundingVolumeHierarchy<S> tree(boxes);
        indices_.resize(width, points.cols());
        weights_.resize(width, points.cols());
        cells_.resize(size_t(points.cols()));
        distances_.resize(points.cols());
        executor.for_each_range(points.cols(), [&](Index begin, Index end) {
            for (Index p = begin; p < end; ++p) {
                place(p, points.col(p), tree, meshes...);
            }
        });
        for (Index p = 0; p < num_points(); ++p) {
            if (indices_.col(p).maxCoeff() == num_vertices_ - 1) {
                at_last_vertex_.push_back(p);
            }
        }
        make_report(tree);
    }

    /// Finds the cell of point number `number`. A prism's corners hold it in their box, as its shape functions are convex
    /// weights.
    template <class... Meshes>
    void place(Index number, const Vector3<S>& p, const BoundingVolumeHierarchy<S>& tree, const Meshes&... meshes) {
        std::int32_t found = tree.no_item;
        tree.for_each_containing(p, [&](std::int32_t c) {
            const auto look = [&](const auto& mesh, Index cell) {
                using E = typename std::remove_cvref_t<decltype(mesh)>::CellElement;
                const NaturalCoordinates<S> xi = E::natural_coordinates(mesh.rest_nodes(cell), p);
                found = xi.converged && is_in_reference_cell<E, S>(xi.coordinates) ? c : found;
            };
            if (found == tree.no_item) {
                visit_cell(c, look, meshes...);
            }
        });
        if (found == tree.no_item) {
            const auto squared_distance = [&](std::int32_t c) {
                S result(0);
                const auto measure = [&](const auto& mesh, Index cell) {
                    using E = typename std::remove_cvref_t<decltype(mesh)>::CellElement;
                    result = closest_point_in_cell<E, S>(mesh.rest_nodes(cell), p).squared_distance;
                };
                visit_cell(c, measure, meshes...);
                return result;
            };
            found = tree.nearest(p, squared_distance).item;
        }
        cells_[size_t(number)] = found;
        visit_cell(
            found, [&](const auto& mesh, Index cell) { set_row(number, p, mesh, cell); }, meshes...);
    }

    template <class E>
    void set_row(Index number, const Vector3<S>& p, const CellMesh<E, S>& mesh, Index cell) {
        const NodePositions<E, S> X = mesh.rest_nodes(cell);
        const CellPoint<S> closest = closest_point_in_cell<E, S>(X, p);
        const NodeValues<E, S> N = E::shape_values(closest.coordinates);
        const NodePositions<E, S> local = X.colwise() - p;
        const Vector3<S> offset = -(local * N);
        // Inside, the offset is what rounding left of the inverse map: it makes thin cells exact in float.
        const NodeValues<E, S> w = N + E::gradient_operator(X).transpose() * offset;
        indices_.col(number).setConstant(mesh.cells(0, cell));
        weights_.col(number).setZero();
        indices_.col(number).template head<E::num_nodes>() = mesh.cells.col(cell);
        weights_.col(number).template head<E::num_nodes>() = w;
        distances_(number) = std::sqrt(closest.squared_distance);
    }

    void make_report(const BoundingVolumeHierarchy<S>& tree) {
        const Box<S>& bounds = tree.nodes().front().box;
        const S rounding = S(16) * std::numeric_limits<S>::epsilon() *
                           std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
        for (Index p = 0; p < num_points(); ++p) {
            report_.num_outside += distances_(p) > rounding ? 1 : 0;
            if (distances_(p) > std::max(rounding, report_.largest_distance)) {
                report_.largest_distance = distances_(p);
                report_.farthest_point = p;
            }
        }
    }

    Index num_vertices_ = 0;
    Indices indices_;
    Weights weights_;
    std::vector<Index> at_last_vertex_;  ///< points that move with it, ascending
    std::vector<std::int32_t> cells_;
    VectorX<S> distances_;
    EmbeddingReport<S> report_;
};

}  // namespace softtissue
