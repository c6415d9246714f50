// SPDX-License-Identifier: MIT
/// @file
/// A dense layer of a network, its parameters lying with the caller.
///
/// What        Linear: value, gradient by its parameters, gradient by its input, of a batch of columns
/// Equation    y = W x + b;   dW = dy x^T,  db = sum of the columns of dy;   dx = W^T dy
/// Shapes      x: inputs x batch, y: outputs x batch, one sample a column.
///             parameters: W (outputs x inputs, row after row as PyTorch stores it), then b.
/// Threads     W is cut into the same ranges of rows for every executor: same bits for any number of threads
/// Refuses     sizes below one (InvalidInput); arguments of other sizes are a caller's bug (SOFTTISSUE_ASSERT)
/// Cost        2 flop an entry of W and sample, each way; up to four samples one reading of W. The value allocates nothing.
/// Tests       tests/unit/nn/linear_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/batch_product.hpp>

#include <algorithm>

namespace softtissue {

template <RealScalar S>
class Linear {
public:
    using Scalar = S;
    using WeightMatrix = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    Linear(Index inputs, Index outputs) : inputs_(inputs), outputs_(outputs) {
        require(inputs >= 1 && outputs >= 1, "linear layer of ", inputs, " inputs and ", outputs,
                " outputs, expected at least one of each");
    }

    Index inputs() const { return inputs_; }
    Index outputs() const { return outputs_; }
    Index num_parameters() const { return outputs_ * (inputs_ + 1); }

    /// Views of parameters, or of their gradient.
    Eigen::Map<WeightMatrix> weight(Eigen::Ref<VectorX<S>> parameters) const {
        return {parameters.data(), outputs_, inputs_};
    }
    Eigen::Map<VectorX<S>> bias(Eigen::Ref<VectorX<S>> parameters) const {
        return {parameters.data() + outputs_ * inputs_, outputs_};
    }
    Eigen::Map<const WeightMatrix> const_weight(ConstRef<VectorX<S>> parameters) const {
        return {parameters.data(), outputs_, inputs_};
    }
    Eigen::Map<const VectorX<S>> const_bias(ConstRef<VectorX<S>> parameters) const {
        return {parameters.data() + outputs_ * inputs_, outputs_};
    }

    /// y = W x + b.
    template <Executor E = SequentialExecutor>
    void forward_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y,
                      const E& executor = {}) const {
        SOFTTISSUE_ASSERT(parameters.size() == num_parameters() && x.rows() == inputs_ && y.rows() == outputs_ &&
                          y.cols() == x.cols());
        const Eigen::Map<const WeightMatrix> W = const_weight(parameters);
        const Eigen::Map<const VectorX<S>> b = const_bias(parameters);
        for_each_chunk(executor, [&](Index, Index first, Index rows) {
            y.middleRows(first, rows).colwise() = b.segment(first, rows);
            if (x.cols() == 1) {
                y.col(0).segment(first, rows).noalias() += W.middleRows(first, rows) * x.col(0);
            } else if (x.cols() <= largest_small_batch) {
                add_batch_product<S>(W.row(first).data(), x, y.middleRows(first, rows));
            } else {
                add_in_pieces(W.middleRows(first, rows), x, y.middleRows(first, rows));
            }
        });
    }

    /// The gradient by the parameters, of a function whose gradient by y is dy. Overwrites.
    template <Executor E = SequentialExecutor>
    void gradient_into(ConstRef<MatrixX<S>> x, ConstRef<MatrixX<S>> dy, Eigen::Ref<VectorX<S>> gradient,
                       const E& executor = {}) const {
        SOFTTISSUE_ASSERT(gradient.size() == num_parameters() && x.rows() == inputs_ && dy.rows() == outputs_ &&
                          dy.cols() == x.cols());
        Eigen::Map<WeightMatrix> dW = weight(gradient);
        Eigen::Map<VectorX<S>> db = bias(gradient);
        for_each_chunk(executor, [&](Index, Index first, Index rows) {
            dW.middleRows(first, rows).noalias() = dy.middleRows(first, rows) * x.transpose();
            db.segment(first, rows) = dy.col(0).segment(first, rows);
            for (Index sample = 1; sample < dy.cols(); ++sample) {
                db.segment(first, rows) += dy.col(sample).segment(first, rows);
            }
        });
    }

    /// Columns of the `parts` of input_gradient_into().
    Index num_part_columns(Index batch) const { return num_chunks() * batch; }

    /// dx = W^T dy. `parts` (inputs x num_part_columns) takes one product a range of rows, which are then added in order.
    template <Executor E = SequentialExecutor>
    void input_gradient_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> dy, Eigen::Ref<MatrixX<S>> parts,
                             Eigen::Ref<MatrixX<S>> dx, const E& executor = {}) const {
        const Index batch = dy.cols();
        SOFTTISSUE_ASSERT(parameters.size() == num_parameters() && dy.rows() == outputs_ && dx.rows() == inputs_ &&
                          dx.cols() == batch && parts.rows() == inputs_ && parts.cols() >= num_part_columns(batch));
        const Eigen::Map<const WeightMatrix> W = const_weight(parameters);
        for_each_chunk(executor, [&](Index chunk, Index first, Index rows) {
            parts.middleCols(chunk * batch, batch).noalias() =
                W.middleRows(first, rows).transpose() * dy.middleRows(first, rows);
        });
        dx = parts.leftCols(batch);
        for (Index chunk = 1; chunk < num_chunks(); ++chunk) {
            dx += parts.middleCols(chunk * batch, batch);
        }
    }

private:
    /// Beyond this Eigen's product is faster than one without copies.
    static constexpr Index largest_small_batch = 8;

    /// y += W x in pieces whose copies Eigen puts on the stack.
    static void add_in_pieces(ConstRef<WeightMatrix> W, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y) {
        constexpr Index stack = 1 << 17, depth = 256, width = stack / (depth * Index(sizeof(S)));
        for (Index row = 0; row < W.rows(); row += width) {
            const Index rows = std::min(width, W.rows() - row);
            for (Index sample = 0; sample < x.cols(); sample += width) {
                const Index samples = std::min(width, x.cols() - sample);
                for (Index k = 0; k < W.cols(); k += depth) {
                    const Index terms = std::min(depth, W.cols() - k);
                    y.block(row, sample, rows, samples).noalias() +=
                        W.block(row, k, rows, terms) * x.block(k, sample, terms, samples);
                }
            }
        }
    }

    /// Enough rows to be worth a thread's while, and at most 64 ranges; a multiple of 16.
    Index rows_per_chunk() const { return std::max(Index(256), (outputs_ + 1023) / 1024 * 16); }
    Index num_chunks() const { return (outputs_ + rows_per_chunk() - 1) / rows_per_chunk(); }

    /// body(chunk, first row, rows)
    template <class E, class Body>
    void for_each_chunk(const E& executor, const Body& body) const {
        executor.for_each_range(num_chunks(), [&](Index begin, Index end) {
            for (Index chunk = begin; chunk < end; ++chunk) {
                const Index first = chunk * rows_per_chunk();
                body(chunk, first, std::min(rows_per_chunk(), outputs_ - first));
            }
        });
    }

    Index inputs_, outputs_;
};

}  // namespace softtissue
