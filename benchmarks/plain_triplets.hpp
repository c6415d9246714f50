// SPDX-License-Identifier: MIT
/// @file
/// What baselines do with the Hessian of a prism: its blocks, one entry after the other, as triplets of a sparse matrix.
///
/// Equation    block (a, b) = sum_kl H_(.k)(.l) g_a[k] g_b[l] on the free vertices of the cell; H times the cell's volume, 9x9 on
///             column-major vec(F)
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>

#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace benchmarks {

/// A 3x3 block at free vertices i, j.
template <class S>
void append_block(softtissue::Index i, softtissue::Index j, const softtissue::Matrix3<S>& block,
                  std::vector<Eigen::Triplet<S>>& triplets) {
    for (int k = 0; k < 9; ++k) {
        triplets.emplace_back(int(3 * i + k % 3), int(3 * j + k / 3), block.data()[k]);
    }
}

template <class S>
void append_prism(const softtissue::Matrix9<S>& H, const softtissue::NodePositions<softtissue::Prism6, S>& g,
                  const softtissue::Connectivity<6>& cells, softtissue::Index cell,
                  const softtissue::PrescribedVertices& prescribed, std::vector<Eigen::Triplet<S>>& triplets) {
    for (int b = 0; b < 6; ++b) {
        const Eigen::Matrix<S, 9, 3> T = g(0, b) * H.template leftCols<3>() + g(1, b) * H.template middleCols<3>(3) +
                                         g(2, b) * H.template rightCols<3>();
        const std::int32_t column = prescribed.free_index(cells(b, cell));
        for (int a = 0; a < 6 && column >= 0; ++a) {
            const std::int32_t row = prescribed.free_index(cells(a, cell));
            if (row >= 0) {
                append_block<S>(row, column,
                                g(0, a) * T.template topRows<3>() + g(1, a) * T.template middleRows<3>(3) +
                                    g(2, a) * T.template bottomRows<3>(),
                                triplets);
            }
        }
    }
}

}  // namespace benchmarks
