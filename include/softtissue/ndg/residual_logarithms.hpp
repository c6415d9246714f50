// SPDX-License-Identifier: MIT
/// @file
/// Logarithms of residual gradients: what a network predicts before its exponential.
///
/// What        replaces every matrix by its principal logarithm, for a decoder that is linear in logarithms.
/// Shapes      9 x cells, or 9 cells x samples: 3x3 matrices one after the other
/// Valid       a matrix with a negative determinant, or one that is nearly singular, has no logarithm that a network should
///             learn: its singular values (the smallest with the determinant's sign) are raised to smallest_stretch first, and
///             it is counted as repaired. If there is no principal logarithm even then (a rotation by pi), the result is 0 and
///             the matrix counted as dropped.
/// Source      Nolte et al. 2026, eq. (15), reversed
/// Cost        a microsecond a matrix; same bits for every executor
/// Tests       tests/unit/ndg/residual_logarithms_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/matrix_logarithm.hpp>
#include <softtissue/linalg/svd3.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace softtissue {

/// Softer than any flesh in equilibrium, and well within reach of a network: the logarithm is -2.3.
template <RealScalar S>
inline constexpr S smallest_stretch = S(0.1);

struct LogarithmCounts {
    Index repaired = 0;
    Index dropped = 0;
};

/// Replaces residual gradients by their logarithms.
template <RealScalar S, Executor E = SequentialExecutor>
LogarithmCounts residual_logarithms_in_place(Eigen::Ref<MatrixX<S>> residuals, const E& executor = {}) {
    require(residuals.rows() % 9 == 0 && residuals.rows() == residuals.outerStride(),
            "residual logarithms: columns of ", residuals.rows(), " numbers, expected nine a matrix, without gaps");
    Eigen::Map<Eigen::Matrix<S, 9, Eigen::Dynamic>> matrices(residuals.data(), 9, residuals.size() / 9);
    enum Outcome : std::uint8_t { found, repaired, dropped };
    std::vector<Outcome> outcomes(size_t(matrices.cols()), found);
    executor.for_each_range(matrices.cols(), [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
            Matrix3<S> F = matrices.col(k).reshaped(3, 3);
            const Matrix3<S> cof = cofactor(F);
            // |cof F| / det F = |F^-1| bounds the smallest singular value from below: most matrices need no decomposition.
            if (!(determinant(F, cof) > smallest_stretch<S> * cof.norm())) {
                const Svd3<S> svd = svd3(F);
                if (!(svd.sigma(2) >= smallest_stretch<S>)) {
                    F = svd.U * svd.sigma.cwiseMax(smallest_stretch<S>).asDiagonal() * svd.V.transpose();
                    outcomes[size_t(k)] = repaired;
                }
            }
            const std::optional<Matrix3<S>> Q = matrix_logarithm(F);
            outcomes[size_t(k)] = Q ? outcomes[size_t(k)] : dropped;
            matrices.col(k) = Q.value_or(Matrix3<S>::Zero()).reshaped();
        }
    });
    return {std::count(outcomes.begin(), outcomes.end(), repaired),
            std::count(outcomes.begin(), outcomes.end(), dropped)};
}

}  // namespace softtissue
