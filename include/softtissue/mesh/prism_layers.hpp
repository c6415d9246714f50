// SPDX-License-Identifier: MIT
/// @file
/// Prisms between copies of one triangle surface: the numbering of layered meshes.
///
/// What        the columns of a layered mesh: every surface vertex carries num_layers + 1 mesh vertices, one per level.
/// Order       vertex(column, level) = column (num_layers + 1) + level; level 0 is the innermost, level num_layers the
///             outermost. The vertices of a column lie side by side, so its free dofs form one dense block for solvers, and
///             one level is still a strided view without a copy: level_positions().
///             Prism of triangle t in layer l: cell t num_layers + l; nodes 0-2 at level l, nodes 3-5 at level l + 1, in the
///             order of the triangle, so that an outward-facing triangle gives a positive volume.
/// Tests       tests/unit/mesh/prism_layers_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cstdint>

namespace softtissue {

struct PrismLayers {
    Index num_columns = 0;
    Index num_layers = 1;

    Index num_levels() const { return num_layers + 1; }
    Index num_vertices() const { return num_columns * num_levels(); }
    Index vertex(Index column, Index level) const { return column * num_levels() + level; }
    Index column(Index vertex) const { return vertex / num_levels(); }
    Index level(Index vertex) const { return vertex % num_levels(); }

    /// The prisms over `triangles` (of columns), 6 x (num_layers m).
    Connectivity<6> prisms(const Triangles& triangles) const {
        checked_index(num_vertices(), "prism layers: vertices");
        checked_index(triangles.cols() * num_layers, "prism layers: prisms");
        Connectivity<6> cells(6, triangles.cols() * num_layers);
        for (Index t = 0; t < triangles.cols(); ++t) {
            for (Index layer = 0; layer < num_layers; ++layer) {
                for (int k = 0; k < 3; ++k) {
                    const std::int32_t lower = static_cast<std::int32_t>(vertex(triangles(k, t), layer));
                    cells(k, t * num_layers + layer) = lower;
                    cells(k + 3, t * num_layers + layer) = lower + 1;
                }
            }
        }
        return cells;
    }

    /// The positions of one level, 3 x num_columns, seen in those of all vertices; binds to ConstRef without a copy.
    template <RealScalar S>
    Eigen::Map<const Matrix3X<S>, 0, Eigen::OuterStride<>> level_positions(const Matrix3X<S>& positions,
                                                                           Index level) const {
        return {positions.data() + 3 * level, 3, num_columns, Eigen::OuterStride<>(3 * num_levels())};
    }
};

}  // namespace softtissue
