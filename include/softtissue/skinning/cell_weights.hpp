// SPDX-License-Identifier: MIT
/// @file
/// Skinning weights of cells: which joints move a prism or a tetrahedron.
///
/// What        the mean of the weights of a cell's nodes, that is the interpolated weights at its centre.
/// Shapes      cells num_nodes x cells; result one row per cell.
/// Refuses     a node out of range (InvalidInput names the cell).
/// Source      Nolte et al. 2026, eq. (11), w_{p,b}
/// Tests       tests/unit/skinning/cell_weights_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/weights.hpp>

namespace softtissue {

template <RealScalar S, int num_nodes>
SkinningWeights<S> cell_weights(const SkinningWeights<S>& vertex_weights, const Connectivity<num_nodes>& cells) {
    MatrixX<S> dense = MatrixX<S>::Zero(cells.cols(), vertex_weights.num_joints());
    for (Index cell = 0; cell < cells.cols(); ++cell) {
        for (int node = 0; node < num_nodes; ++node) {
            const Index v = cells(node, cell);
            require(v >= 0 && v < vertex_weights.num_vertices(), "cell_weights: node ", node, " of cell ", cell,
                    " is vertex ", v, ", expected 0 to ", vertex_weights.num_vertices() - 1);
            for (const auto& [joint, weight] : vertex_weights.row(v)) {
                dense(cell, joint) += weight / S(num_nodes);
            }
        }
    }
    return SkinningWeights<S>(dense);
}

}  // namespace softtissue
