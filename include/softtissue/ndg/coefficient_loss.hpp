// SPDX-License-Identifier: MIT
/// @file
/// How far predicted coefficients of a linear decoder are from the wanted ones, weighted by what each of them moves.
///
/// What        an OutputLoss (network_training.hpp) that needs no decoding.
/// Equation    loss = mean over the batch of sum_k w_k (y_k - c_k)^2. With a decoder whose columns d_k are orthogonal and
///             w_k = |d_k|^2 / m this is the mean squared error of the m decoded numbers, less what the decoder cannot express.
/// Shapes      outputs and targets coefficients x batch and x samples; weights one per coefficient
/// Source      Han et al. 2024, as Nolte et al. 2026 use it in sec. 5.2.1
/// Tests       tests/unit/ndg/coefficient_loss_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cstdint>
#include <span>

namespace softtissue {

template <RealScalar S>
struct CoefficientLoss {
    using Scalar = S;

    VectorX<S> weights;

    /// The mean loss of a batch whose targets are the given columns of `targets`.
    template <Executor E>
    double loss(ConstRef<MatrixX<S>> outputs, const MatrixX<S>& targets, std::span<const std::int32_t> columns,
                const E&) const {
        require_sizes(outputs, targets, columns);
        double sum = 0;
        for (Index k = 0; k < outputs.cols(); ++k) {
            sum += double(weights.dot((outputs.col(k) - targets.col(columns[size_t(k)])).cwiseAbs2()));
        }
        return sum / double(outputs.cols());
    }

    /// The same; replaces `outputs` by the derivative of the mean loss by them.
    template <Executor E>
    double loss_and_gradient(Eigen::Ref<MatrixX<S>> outputs, const MatrixX<S>& targets,
                             std::span<const std::int32_t> columns, const E& executor) const {
        const double result = loss(outputs, targets, columns, executor);
        for (Index k = 0; k < outputs.cols(); ++k) {
            outputs.col(k) =
                (S(2) / S(outputs.cols())) * weights.cwiseProduct(outputs.col(k) - targets.col(columns[size_t(k)]));
        }
        return result;
    }

private:
    void require_sizes(ConstRef<MatrixX<S>> outputs, const MatrixX<S>& targets,
                       std::span<const std::int32_t> columns) const {
        require(outputs.rows() == weights.size() && targets.rows() == weights.size(),
                "coefficient loss: ", outputs.rows(), " outputs and ", targets.rows(), " targets, expected ",
                weights.size());
        require(outputs.cols() == Index(columns.size()), "coefficient loss: ", columns.size(), " samples, expected ",
                outputs.cols());
    }
};

}  // namespace softtissue
