// SPDX-License-Identifier: MIT
/// @file
/// Columns of a Cholesky factor in strips of a few, and both triangular sweeps over them.
///
/// What        eliminate(): y <- L^-1 y, substitute(): y <- L^-T y, for right-hand sides side by side
/// Equation    a strip of columns C with the inverse of its diagonal block, D, and blocks L_k on the rows R_k:
///             eliminate  y_C <- D y_C, y_R <- y_R - L_k y_C;  substitute  y_C <- D^T (y_C - sum_k L_k^T y_R)
/// Shapes      y 4 x places; a block node_size rows by the strip's columns, by rows; a strip of up to `widest` columns
/// Layout      all numbers in the order in which eliminate() reads them; substitute() reads the same backwards
/// Why         four columns need one index for all their entries in a row, and read and write the row once
/// Cost        16 flop per entry for both sweeps
/// Tests       tests/unit/sparse/factor_strips_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/prefetch.hpp>
#include <softtissue/core/scalar.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
class FactorStrips {
public:
    using Scalar = S;
    /// A dense piece of the factor, as it is given.
    static constexpr int widest = 4;
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, widest, widest>;

    /// node_size 1 or 2: how many consecutive places a block has as rows.
    explicit FactorStrips(int node_size) : node_size_(node_size) {
        SOFTTISSUE_ASSERT(node_size == 1 || node_size == 2);
    }

    /// Stored entries without those of the diagonal blocks.
    Index num_entries() const { return Index(values_.size()); }
    /// What a sweep reads.
    Index num_bytes() const {
        return Index((values_.size() + diagonals_.size()) * sizeof(Scalar) + rows_.size() * sizeof(std::int32_t) +
                     strips_.size() * sizeof(Strip));
    }

    /// Columns first_place, first_place + 1, ...: node_size or `widest` of them.
    void add_strip(std::int32_t first_place, const Block& inverse_diagonal) {
        const std::int32_t columns = static_cast<std::int32_t>(inverse_diagonal.cols());
        SOFTTISSUE_ASSERT(columns == node_size_ || columns == widest);
        strips_.push_back({first_place, columns, 0});
        append(inverse_diagonal, diagonals_);
    }

    /// Rows first_place to first_place + node_size - 1 of the strip added last.
    void add_block(std::int32_t first_place, const Block& L) {
        SOFTTISSUE_ASSERT(L.rows() == node_size_ && L.cols() == strips_.back().columns);
        ++strips_.back().num_blocks;
        rows_.push_back(first_place);
        append(L, values_);
    }

    void eliminate(Scalar* y) const { node_size_ == 2 ? eliminate_all<2>(y) : eliminate_all<1>(y); }
    void substitute(Scalar* y) const { node_size_ == 2 ? substitute_all<2>(y) : substitute_all<1>(y); }

private:
    using Lanes = Eigen::Array<Scalar, 4, 1>;

    struct Strip {
        std::int32_t first_place, columns, num_blocks;
    };

    /// Where in the factor a sweep has come to.
    struct Cursor {
        const Scalar* diagonal;
        const Scalar* block;
        const std::int32_t* row;
    };

    static void append(const Block& block, std::vector<Scalar>& values) {
        for (const double value : block.template reshaped<Eigen::RowMajor>()) {
            values.push_back(Scalar(value));
        }
    }

    static Eigen::Map<Lanes> lanes(Scalar* y, Index place) { return Eigen::Map<Lanes>(y + 4 * place); }

    /// Hardware reads ahead within a page only.
    static constexpr Index ahead = 2048 / Index(sizeof(Scalar));

    template <int rows>
    void eliminate_all(Scalar* y) const {
        Cursor at{diagonals_.data(), values_.data(), rows_.data()};
        for (const Strip& strip : strips_) {
            strip.columns == widest ? eliminate<rows, widest>(strip, at, y) : eliminate<rows, rows>(strip, at, y);
        }
    }

    template <int rows>
    void substitute_all(Scalar* y) const {
        Cursor at{diagonals_.data() + diagonals_.size(), values_.data() + values_.size(), rows_.data() + rows_.size()};
        for (size_t k = strips_.size(); k-- > 0;) {
            const Strip& strip = strips_[k];
            strip.columns == widest ? substitute<rows, widest>(strip, at, y) : substitute<rows, rows>(strip, at, y);
        }
    }

    template <int rows, int columns>
    static void eliminate(const Strip& strip, Cursor& at, Scalar* y) {
        std::array<Lanes, size_t(columns)> a;
        for (int r = 0; r < columns; ++r) {
            a[size_t(r)] = at.diagonal[columns * r + r] * lanes(y, strip.first_place + r);
            for (int c = 0; c < r; ++c) {
                a[size_t(r)] += at.diagonal[columns * r + c] * lanes(y, strip.first_place + c);
            }
        }
        for (int c = 0; c < columns; ++c) {
            lanes(y, strip.first_place + c) = a[size_t(c)];
        }
        const Scalar* L = at.block;
        const std::int32_t* const end = at.row + strip.num_blocks;
        for (const std::int32_t* row = at.row; row != end; ++row, L += rows * columns) {
            prefetch(L + ahead);
            for (int r = 0; r < rows; ++r) {
                Lanes sum = lanes(y, *row + r);
                for (int c = 0; c < columns; ++c) {
                    sum -= L[columns * r + c] * a[size_t(c)];
                }
                lanes(y, *row + r) = sum;
            }
        }
        at = {at.diagonal + columns * columns, L, end};
    }

    template <int rows, int columns>
    static void substitute(const Strip& strip, Cursor& at, Scalar* y) {
        // a sum for each entry of a block, that none waits for another; backwards through memory all along
        std::array<std::array<Lanes, size_t(columns)>, size_t(rows)> sums;
        for (auto& of_row : sums) {
            of_row.fill(Lanes::Zero());
        }
        const Scalar* L = at.block;
        const std::int32_t* const end = at.row - strip.num_blocks;
        for (const std::int32_t* row = at.row; row != end;) {
            L -= rows * columns;
            --row;
            prefetch(L - ahead);
            for (int r = 0; r < rows; ++r) {
                const Lanes y_r = lanes(y, *row + r);
                for (int c = 0; c < columns; ++c) {
                    sums[size_t(r)][size_t(c)] += L[columns * r + c] * y_r;
                }
            }
        }
        at = {at.diagonal - columns * columns, L, end};
        std::array<Lanes, size_t(columns)> a;
        for (int c = 0; c < columns; ++c) {
            a[size_t(c)] = lanes(y, strip.first_place + c);
            for (int r = 0; r < rows; ++r) {
                a[size_t(c)] -= sums[size_t(r)][size_t(c)];
            }
        }
        for (int c = 0; c < columns; ++c) {
            Lanes x = at.diagonal[columns * c + c] * a[size_t(c)];
            for (int r = c + 1; r < columns; ++r) {
                x += at.diagonal[columns * r + c] * a[size_t(r)];
            }
            lanes(y, strip.first_place + c) = x;
        }
    }

    int node_size_;
    std::vector<Strip> strips_;
    std::vector<std::int32_t> rows_;  // first place of each block
    std::vector<Scalar> values_;      // blocks by rows
    std::vector<Scalar> diagonals_;   // inverse diagonal blocks by rows
};

}  // namespace softtissue
