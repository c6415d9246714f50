// SPDX-License-Identifier: MIT
/// @file
/// A volume mesh: rest positions and cells of one element type.
///
/// What        the rest shape that elasticity is measured against, and its connectivity.
/// Shapes      rest_positions 3 x vertices [m]; cells num_nodes x cells, node order as the element documents.
/// Refuses     validate(): an index out of range, a repeated vertex in a cell, a position that is not finite, a cell whose
///             Jacobian is not positive everywhere (InvalidInput names cell and value).
/// Tests       tests/unit/mesh/cell_mesh_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/concepts.hpp>

namespace softtissue {

template <class ElementType, RealScalar S>
    requires Element<ElementType, S>
struct CellMesh {
    using Scalar = S;
    using CellElement = ElementType;
    static constexpr int num_nodes = ElementType::num_nodes;

    Matrix3X<Scalar> rest_positions;
    Connectivity<num_nodes> cells;

    Index num_vertices() const { return rest_positions.cols(); }
    Index num_cells() const { return cells.cols(); }

    /// The nodes of `cell` at the positions `x` (3 x vertices).
    static NodePositions<ElementType, Scalar> gather(ConstRef<Matrix3X<Scalar>> x,
                                                     const Eigen::Matrix<std::int32_t, num_nodes, 1>& cell) {
        NodePositions<ElementType, Scalar> nodes;
        for (int i = 0; i < num_nodes; ++i) {
            nodes.col(i) = x.col(cell(i));
        }
        return nodes;
    }

    /// The rest positions of the nodes of `cell`.
    NodePositions<ElementType, Scalar> rest_nodes(Index cell) const { return gather(rest_positions, cells.col(cell)); }

    /// Cells that are not proven positive everywhere at the positions `x`.
    Index count_inverted(ConstRef<Matrix3X<Scalar>> x) const {
        Index inverted = 0;
        for (Index c = 0; c < num_cells(); ++c) {
            inverted += ElementType::smallest_jacobian_bound(gather(x, cells.col(c))) > Scalar(0) ? 0 : 1;
        }
        return inverted;
    }

    void validate() const {
        for (Index v = 0; v < num_vertices(); ++v) {
            require(rest_positions.col(v).allFinite(), "mesh: rest position of vertex ", v, " is not finite");
        }
        for (Index c = 0; c < num_cells(); ++c) {
            for (int i = 0; i < num_nodes; ++i) {
                require(cells(i, c) >= 0 && cells(i, c) < num_vertices(), "mesh: cell ", c, ", node ", i, " is vertex ",
                        cells(i, c), ", expected 0 to ", num_vertices() - 1);
                for (int k = 0; k < i; ++k) {
                    require(cells(i, c) != cells(k, c), "mesh: cell ", c, " uses vertex ", cells(i, c), " twice");
                }
            }
            const Scalar bound = ElementType::smallest_jacobian_bound(rest_nodes(c));
            require(bound > Scalar(0), "mesh: cell ", c, " has a rest Jacobian bound of ", bound,
                    ", expected > 0 (inverted or degenerate cell, or nodes in the wrong order)");
        }
    }
};

}  // namespace softtissue
