// SPDX-License-Identifier: MIT
/// @file
/// How far predicted residual gradients are from simulated ones, and the derivative by the network's outputs.
///
/// What        an OutputLoss (network_training.hpp).
/// Equation    loss = mean over the batch of 1/(9 N_p) sum_p |exp(Q_p) - F_p^res|^2; without the exponential I + Q_p
/// Shapes      outputs 9 N_p x batch: cell after cell, 3x3 row after row; targets 9 N_p x samples alike
/// Valid       any target, also of a cell with a negative determinant
/// Source      Nolte et al. 2026, eq. (15) and (17); sec. 5.5 for the variant without the exponential
/// Departs     a mean over the samples in place of their sum: AdamW does not see the difference
/// Cost        two exponentials and their derivatives a cell, blocks of which fit the cache. Same bits for every executor.
/// Tests       tests/unit/ndg/gradient_loss_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct GradientLoss {
    using Scalar = S;

    bool exponential = true;

    /// The mean loss of a batch whose targets are the given columns of `targets`.
    template <Executor E>
    double loss(ConstRef<MatrixX<S>> outputs, const MatrixX<S>& targets, std::span<const std::int32_t> columns,
                const E& executor) const {
        std::vector<double> sums = block_sums(outputs, targets, columns);
        executor.for_each_range(Index(sums.size()), [&](Index begin, Index end) {
            Block F;
            for (Index k = begin; k < end; ++k) {
                const Part part = part_of(outputs.rows(), k);
                sums[size_t(k)] = difference_into(outputs, targets, columns, part, F);
            }
        });
        return total(sums, outputs);
    }

    /// The same; replaces `outputs` by the derivative of the mean loss by them.
    template <Executor E>
    double loss_and_gradient(Eigen::Ref<MatrixX<S>> outputs, const MatrixX<S>& targets,
                             std::span<const std::int32_t> columns, const E& executor) const {
        std::vector<double> sums = block_sums(outputs, targets, columns);
        const S factor = S(2) / S(outputs.size());
        executor.for_each_range(Index(sums.size()), [&](Index begin, Index end) {
            Block D;
            for (Index k = begin; k < end; ++k) {
                const Part part = part_of(outputs.rows(), k);
                sums[size_t(k)] = difference_into(outputs, targets, columns, part, D);
                D *= factor;
                Eigen::Map<Matrix9X<S>> Q(outputs.col(part.column).data() + part.first, 9, part.num_cells);
                if (exponential) {
                    matrix_exponential_pullbacks_into<S>(Q, D, Q);
                } else {
                    Q = D;
                }
            }
        });
        return total(sums, outputs);
    }

private:
    static constexpr Index cells_per_block = 512;
    using Block = Eigen::Matrix<S, 9, Eigen::Dynamic, Eigen::ColMajor, 9, cells_per_block>;

    struct Part {
        Index column, first, num_cells;  // `first` counts numbers, not cells
    };

    static Index blocks_per_column(Index rows) { return (rows / 9 + cells_per_block - 1) / cells_per_block; }

    static Part part_of(Index rows, Index block) {
        const Index blocks = blocks_per_column(rows);
        const Index first_cell = (block % blocks) * cells_per_block;
        return {block / blocks, 9 * first_cell, std::min(cells_per_block, rows / 9 - first_cell)};
    }

    static std::vector<double> block_sums(ConstRef<MatrixX<S>> outputs, const MatrixX<S>& targets,
                                          std::span<const std::int32_t> columns) {
        require(outputs.rows() % 9 == 0 && targets.rows() == outputs.rows(), "gradient loss: ", outputs.rows(),
                " outputs and ", targets.rows(), " targets, expected nine a cell");
        require(outputs.cols() == Index(columns.size()), "gradient loss: ", columns.size(), " samples, expected ",
                outputs.cols());
        return std::vector<double>(size_t(blocks_per_column(outputs.rows()) * outputs.cols()));
    }

    /// F^ - F of a block, and the sum of its squares.
    double difference_into(ConstRef<MatrixX<S>> outputs, const MatrixX<S>& targets,
                           std::span<const std::int32_t> columns, const Part& part, Block& difference) const {
        const Index sample = columns[size_t(part.column)];
        const Eigen::Map<const Matrix9X<S>> Q(outputs.col(part.column).data() + part.first, 9, part.num_cells);
        const Eigen::Map<const Matrix9X<S>> F(targets.col(sample).data() + part.first, 9, part.num_cells);
        difference.resize(9, part.num_cells);
        if (exponential) {
            matrix_exponentials_into<S>(Q, difference);
            difference -= F;
        } else {
            difference = Q - F;
            for (const int diagonal : {0, 4, 8}) {
                difference.row(diagonal).array() += S(1);
            }
        }
        return double(difference.squaredNorm());
    }

    static double total(const std::vector<double>& sums, ConstRef<MatrixX<S>> outputs) {
        double sum = 0;
        for (const double part : sums) {
            sum += part;
        }
        return sum / double(outputs.size());
    }
};

}  // namespace softtissue
