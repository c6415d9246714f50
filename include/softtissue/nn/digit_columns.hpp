// SPDX-License-Identifier: MIT
/// @file
/// Columns of whole numbers of sixteen bits, in two digits, that packed integer weights are multiplied with.
///
/// What        DigitColumns: a batch of columns, each with its own step, rounded to multiples of it
/// Equation    x = step (256 high + low) + r, |r| <= step / 2 up to rounding of x / step;  step = max |x| / 32639;
///             high in -127 .. 127, low in -128 .. 127
/// Shapes      columns: depth x batch. In memory four high digits in one word, then the four low ones of the same numbers.
/// Valid       a column whose largest number is below 1e-33 counts as zero. One with a number that is not finite gets the
///             step NaN: so does every result.
/// Cost        a few operations a number; allocates what reserve() did not
/// Tests       tests/unit/nn/digit_columns_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace softtissue {

class DigitColumns {
public:
    using Element = std::int32_t;
    static constexpr Index block = 8;  ///< depth is filled up to a multiple of it
    static constexpr int largest = 127 * 256 + 127;

    /// What holds for a whole column.
    struct Summary {
        float step = 0.0F;
        std::int32_t high_sum = 0, low_sum = 0;  ///< of the digits
    };

    void reserve(Index depth, Index batch) {
        words_.resize(std::max(words_.size(), size_t(batch * num_words(depth))));
        summaries_.resize(std::max(summaries_.size(), size_t(batch)));
    }

    template <RealScalar S>
    void set(ConstRef<MatrixX<S>> columns) {
        reserve(columns.rows(), columns.cols());
        stride_ = num_words(columns.rows());
        batch_ = columns.cols();
        for (Index sample = 0; sample < batch_; ++sample) {
            summaries_[size_t(sample)] =
                split(columns.col(sample).data(), columns.rows(), words_.data() + sample * stride_);
        }
    }

    Index batch() const { return batch_; }
    const std::int32_t* column(Index sample) const { return words_.data() + sample * stride_; }
    const Summary& summary(Index sample) const { return summaries_[size_t(sample)]; }

private:
    static Index num_words(Index depth) { return (depth + block - 1) / block * block / 2; }

    template <RealScalar S>
    static float step_of(const S* numbers, Index count) {
        S peak = S(0);
        bool is_finite = true;
        for (Index i = 0; i < count; ++i) {
            const S magnitude = std::abs(numbers[i]);
            is_finite = is_finite && magnitude <= S(std::numeric_limits<float>::max());
            peak = std::max(peak, magnitude);
        }
        if (!is_finite) {
            return std::numeric_limits<float>::quiet_NaN();
        }
        return peak < S(1e-33) ? 0.0F : float(peak) / float(largest);
    }

    template <RealScalar S>
    Summary split(const S* numbers, Index count, std::int32_t* words) const {
        Summary summary{.step = step_of(numbers, count)};
        std::fill(words, words + stride_, 0);
        if (!(summary.step > 0.0F)) {
            return summary;
        }
        const S inverse = S(1) / S(summary.step);
        for (Index i = 0; i < count; ++i) {
            const int rounded = static_cast<int>(std::rint(numbers[i] * inverse));
            const int number = std::min(std::max(rounded, -largest), largest);
            const int low = static_cast<std::int8_t>(number & 255);
            const int high = (number - low) / 256;
            summary.high_sum += high;
            summary.low_sum += low;
            std::int32_t* const pair = words + i / 4 * 2;
            const int shift = static_cast<int>(i % 4) * 8;
            pair[0] |= (high & 255) << shift;
            pair[1] |= (low & 255) << shift;
        }
        return summary;
    }

    std::vector<std::int32_t> words_;
    std::vector<Summary> summaries_;
    Index stride_ = 0, batch_ = 0;
};

}  // namespace softtissue
