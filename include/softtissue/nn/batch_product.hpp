// SPDX-License-Identifier: MIT
/// @file
/// A wide matrix times a batch of columns, without memory of its own.
///
/// What        y += W x
/// Shapes      W: rows x depth, row after row; x: depth x batch and y: rows x batch, a sample a column, columns a stride apart
/// Why         both factors of every sum lie one number after the other, hence nothing needs to be packed, which is where
///             Eigen's product takes memory, and time for batches below about 8. W is read once for up to four samples.
/// Order       entry (r, s) adds the same numbers in the same order whatever the other rows and samples are
/// Cost        2 rows depth batch flop; rows depth numbers read for each four samples, most of them from cache
/// Tests       tests/unit/nn/batch_product_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_mask.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace softtissue {

namespace detail {

/// `rows` rows of W and `samples` columns of x at a time: enough sums that none waits for another, few enough for registers.
template <RealScalar S>
class BatchProduct {
public:
    const S* W;
    const S* x;
    S* y;
    Index depth, x_stride, y_stride;

    void add(Index rows, Index batch) const {
        Index row = 0;
        for (; row + tile_rows <= rows; row += tile_rows) {
            add_rows<tile_rows>(row, batch);
        }
        for (; row < rows; ++row) {
            add_rows<1>(row, batch);
        }
    }

private:
    static constexpr int lanes = std::max(4, natural_lanes<S>);
    static constexpr int tile_rows = 4, tile_samples = 4;
    using Lanes = Eigen::Array<S, lanes, 1>;

    template <int rows>
    void add_rows(Index row, Index batch) const {
        Index sample = 0;
        for (; sample + tile_samples <= batch; sample += tile_samples) {
            add_tile<rows, tile_samples>(row, sample);
        }
        for (; sample + 2 <= batch; sample += 2) {
            add_tile<rows, 2>(row, sample);
        }
        for (; sample < batch; ++sample) {
            add_tile<rows, 1>(row, sample);
        }
    }

    static Lanes load(const S* from) { return Eigen::Map<const Lanes>(from); }
    static Lanes load_rest(const S* from, Index count) {
        Lanes result = Lanes::Zero();
        std::copy(from, from + count, result.data());
        return result;
    }

    template <int rows, int samples>
    void add_tile(Index row, Index sample) const {
        const S* const weights = W + row * depth;
        const S* const columns = x + sample * x_stride;
        std::array<std::array<Lanes, std::size_t(rows)>, std::size_t(samples)> sums;
        for (auto& of_sample : sums) {
            for (Lanes& sum : of_sample) {
                sum.setZero();
            }
        }
        const auto add_lanes = [&](const auto& load_lanes) {
            std::array<Lanes, std::size_t(rows)> w;
            for (int r = 0; r < rows; ++r) {
                w[std::size_t(r)] = load_lanes(weights + r * depth);
            }
            for (int s = 0; s < samples; ++s) {
                const Lanes column = load_lanes(columns + s * x_stride);
                for (int r = 0; r < rows; ++r) {
                    sums[std::size_t(s)][std::size_t(r)] += w[std::size_t(r)] * column;
                }
            }
        };
        Index k = 0;
        for (; k + lanes <= depth; k += lanes) {
            add_lanes([k](const S* from) { return load(from + k); });
        }
        if (k < depth) {
            add_lanes([this, k](const S* from) { return load_rest(from + k, depth - k); });
        }
        for (int s = 0; s < samples; ++s) {
            for (int r = 0; r < rows; ++r) {
                y[(sample + s) * y_stride + row + r] += sums[std::size_t(s)][std::size_t(r)].sum();
            }
        }
    }
};

}  // namespace detail

/// y += W x, W given by its entries row after row.
template <RealScalar S>
void add_batch_product(const S* W, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y) {
    detail::BatchProduct<S>{W, x.data(), y.data(), x.rows(), x.outerStride(), y.outerStride()}.add(y.rows(), y.cols());
}

}  // namespace softtissue
