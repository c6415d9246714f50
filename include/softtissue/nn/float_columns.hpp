// SPDX-License-Identifier: MIT
/// @file
/// Columns of floats that packed weights are multiplied with.
///
/// What        FloatColumns: a batch of columns as floats, filled with zeros up to whole blocks
/// Shapes      columns: depth x batch
/// Valid       any numbers; from double they are rounded
/// Cost        one pass over the columns; allocates what reserve() did not
/// Tests       tests/unit/nn/float_columns_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>

namespace softtissue {

class FloatColumns {
public:
    using Element = float;
    static constexpr Index block = 8;  ///< depth is filled up to a multiple of it

    void reserve(Index depth, Index batch) {
        numbers_.resize(std::max(numbers_.size(), batch * ((depth + block - 1) / block * block)));
    }

    template <RealScalar S>
    void set(ConstRef<MatrixX<S>> columns) {
        reserve(columns.rows(), columns.cols());
        stride_ = (columns.rows() + block - 1) / block * block;
        batch_ = columns.cols();
        for (Index sample = 0; sample < batch_; ++sample) {
            auto to = numbers_.segment(sample * stride_, stride_);
            to.head(columns.rows()) = columns.col(sample).template cast<float>();
            to.tail(stride_ - columns.rows()).setZero();
        }
    }

    Index batch() const { return batch_; }
    const float* column(Index sample) const { return numbers_.data() + sample * stride_; }

private:
    VectorX<float> numbers_;
    Index stride_ = 0, batch_ = 0;
};

}  // namespace softtissue
