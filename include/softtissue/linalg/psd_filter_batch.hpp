// SPDX-License-Identifier: MIT
/// @file
/// Makes many small symmetric matrices positive semi-definite, as many at once as a register has lanes.
///
/// What        filtered() of psd_filter.hpp for each matrix, in packs
/// Shapes      matrices N x N, N fixed, up to about a dozen; of each the lower triangle is read, the result is exactly symmetric
/// Valid       any number of matrices. The result of each depends on itself alone. One that is not finite stays so.
/// Cost        one Cholesky factorisation a pack, and one eigen-decomposition where a matrix of it is not positive definite
/// Tests       tests/unit/linalg/psd_filter_batch_test.cpp
#pragma once

#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <span>

namespace softtissue {

/// Each of the matrices with its negative eigenvalues filtered, in place.
template <RealScalar S, int N>
void filter_in_place(std::span<Eigen::Matrix<S, N, N>> matrices, PsdFilter filter) {
    using Matrix = Eigen::Matrix<S, N, N>;
    constexpr int width = natural_lanes<S>;
    while (!matrices.empty() && filter != PsdFilter::none) {
        const std::span<Matrix> part = matrices.first(std::min(matrices.size(), std::size_t(width)));
        const auto member = [part](int i) -> const Matrix& { return part[std::min(std::size_t(i), part.size() - 1)]; };
        const Eigen::Matrix<Pack<S, width>, N, N> result = filtered(packed_matrix<width>(member), filter);
        for (std::size_t i = 0; i < part.size(); ++i) {
            part[i] = lane(result, int(i));
        }
        matrices = matrices.subspan(part.size());
    }
}

}  // namespace softtissue
