// SPDX-License-Identifier: MIT
/// @file
/// The order in which vertices of a graph are eliminated with little fill.
///
/// What        approximate minimum degree: result[k] is the vertex that is eliminated as the k-th.
/// Source      Amestoy, Davis, Duff 1996, as implemented by Eigen::AMDOrdering
/// Tests       tests/unit/sparse/minimum_degree_order_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/sparse/block_pattern.hpp>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace softtissue {

inline std::vector<std::int32_t> minimum_degree_order(const BlockPattern& graph) {
    const Index n = graph.num_columns();
    Eigen::SparseMatrix<float> pattern(n, n);
    pattern.resizeNonZeros(graph.num_blocks());
    for (Index j = 0; j < n; ++j) {
        pattern.outerIndexPtr()[j] = static_cast<int>(graph.offset(j));
        std::copy(graph.rows(j).begin(), graph.rows(j).end(), pattern.innerIndexPtr() + graph.offset(j));
    }
    pattern.outerIndexPtr()[n] = static_cast<int>(graph.num_blocks());
    pattern.coeffs().setOnes();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), order);
    return {order.indices().data(), order.indices().data() + n};
}

}  // namespace softtissue
