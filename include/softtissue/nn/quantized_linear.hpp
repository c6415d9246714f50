// SPDX-License-Identifier: MIT
/// @file
/// A dense layer of a trained network with its weights in few bytes.
///
/// What        QuantizedLinear: value of a batch of columns
/// Equation    y = W' x' + b, W' the weights as W stores them, x' the columns as it takes them; hence
///             |y - (W x + b)| <= sum |W - W'| |x| + sum |W'| |x - x'| and the rounding of the sums
/// Shapes      x: inputs x batch, y: outputs x batch, one sample a column
/// Refuses     what PackedRows refuses; a bias of another size or that is not finite (InvalidInput). Arguments of other sizes
///             are a caller's bug (SOFTTISSUE_ASSERT).
/// Threads     same bits for every executor
/// Cost        bytes of the weights, read once for up to four samples. The value allocates nothing after reserve().
/// Tests       tests/unit/nn/quantized_linear_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/concepts.hpp>
#include <softtissue/nn/linear.hpp>
#include <softtissue/nn/packed_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace softtissue {

/// body(first row, rows) for ranges of at most 512 rows.
template <class E, class Body>
void for_each_row_range(const E& executor, Index rows, const Body& body) {
    constexpr Index most = 512;
    executor.for_each_range((rows + most - 1) / most, [&](Index begin, Index end) {
        for (Index first = most * begin; first < std::min(most * end, rows); first += most) {
            body(first, std::min(most, rows - first));
        }
    });
}

template <RealScalar S, WeightPacking W>
class QuantizedLinear {
public:
    using Scalar = S;
    using WeightMatrix = typename Linear<S>::WeightMatrix;
    using Scratch = typename W::Columns;

    /// `name` is what a refused weight is said to belong to.
    template <Executor E = SequentialExecutor>
    QuantizedLinear(ConstRef<WeightMatrix> weight, ConstRef<VectorX<S>> bias, const std::string& name,
                    const E& executor = {})
        : rows_(weight.rows(), weight.cols()), bias_(bias) {
        require(bias.size() == weight.rows() && bias.allFinite(), name, ": ", bias.size(), " biases, expected ",
                weight.rows(), " finite numbers");
        for_each_row_range(executor, weight.rows(), [&](Index first, Index count) {
            for (Index r = first; r < first + count; ++r) {
                rows_.set_row(r, weight.row(r).data(), name);
            }
        });
    }

    Index inputs() const { return rows_.inputs(); }
    Index outputs() const { return rows_.rows(); }
    const PackedRows<W>& rows() const { return rows_; }
    std::size_t num_bytes() const { return rows_.num_bytes() + sizeof(S) * size_t(bias_.size()); }

    void reserve(Scratch& scratch, Index batch) const { scratch.reserve(inputs(), batch); }

    /// y = W' x' + b.
    template <Executor E = SequentialExecutor>
    void forward_into(ConstRef<MatrixX<S>> x, Scratch& scratch, Eigen::Ref<MatrixX<S>> y,
                      const E& executor = {}) const {
        SOFTTISSUE_ASSERT(x.rows() == inputs() && y.rows() == outputs() && y.cols() == x.cols());
        scratch.template set<S>(x);
        for_each_row_range(executor, outputs(), [&](Index first, Index count) {
            y.middleRows(first, count).colwise() = bias_.segment(first, count);
            rows_.add_product(first, count, scratch, y.data() + first, y.outerStride());
        });
    }

private:
    PackedRows<W> rows_;
    VectorX<S> bias_;
};

}  // namespace softtissue
