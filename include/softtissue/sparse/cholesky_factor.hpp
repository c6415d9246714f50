// SPDX-License-Identifier: MIT
/// @file
/// A sparse Cholesky factor that is kept to solve for three right-hand sides again and again.
///
/// What        L of P A P^T = L L^T in blocks of nodes; both triangular solves in place, without allocation.
/// Shapes      y 4 x num_places(): one column per unknown, its right-hand sides side by side, the fourth free; unknown u is column
///             place(u). Columns that belong to no unknown must be finite and stay as they are.
/// Why         a solve reads L twice: right-hand sides side by side cost hardly more than one; two unknowns with the same
///             neighbours (both free vertices of a column of prisms) and the next two need one index for eight entries; a
///             factor computed in double and kept in float costs half the bytes and loses only the last rounding
/// Refuses     a matrix that is not positive definite to rounding (InvalidInput names row, pivot and size).
/// Cost        2 reads of L, 16 flop per entry
/// Tests       tests/unit/sparse/cholesky_factor_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace softtissue {

template <RealScalar S>
class CholeskyFactor {
public:
    using Scalar = S;
    using RightHandSides = Eigen::Matrix<Scalar, 4, Eigen::Dynamic>;

    /// Factors the symmetric A, of which the lower triangle is read. `what` begins the message of a refusal.
    CholeskyFactor(const Eigen::SparseMatrix<double>& A, std::string_view what) {
        const SupernodalCholesky<double> cholesky(A);
        require(cholesky.info() == Eigen::Success, what, ": the matrix is not positive definite");
        const std::vector<std::int32_t> places = place_pivots(*cholesky.analysis());
        for (const Front& front : cholesky.analysis()->fronts()) {
            check_pivots(cholesky, front, A, what);
            store(cholesky, front, places);
        }
    }

    /// Unknowns.
    Index size() const { return Index(places_.size()); }
    /// Columns of right-hand sides.
    Index num_places() const { return num_places_; }
    /// Which column each unknown is.
    std::int32_t place(Index unknown) const { return places_[size_t(unknown)]; }

    /// Stored entries of L, without the diagonal blocks.
    Index num_entries() const { return Index(values_.size()); }

    /// y = (L L^T)^-1 y.
    void solve_in_place(Eigen::Ref<RightHandSides> y) const {
        SOFTTISSUE_ASSERT(y.cols() == num_places());
        if (node_size_ == 2) {
            solve<2>(y.data());
        } else {
            solve<1>(y.data());
        }
    }

private:
    using Lanes = Eigen::Array<Scalar, 4, 1>;

    /// A pivot of a regular matrix keeps far more than rounding of its diagonal entry.
    static constexpr double smallest_relative_pivot = 1e4 * std::numeric_limits<double>::epsilon();

    /// Columns that are eliminated together: those of up to two nodes of two unknowns, or of four nodes of one.
    struct Strip {
        std::int32_t first_place, columns;
        Index num_blocks;
    };
    static constexpr std::int32_t widest = 4;

    /// Pairs of pivots within a group, if most unknowns find a partner.
    std::vector<std::int32_t> place_pivots(const SupernodalAnalysis& analysis) {
        const Index n = analysis.num_unknowns();
        std::vector<bool> starts_group(size_t(n), false);
        for (const std::int32_t pivot : analysis.group_pivots()) {
            starts_group[size_t(pivot)] = true;
        }
        std::vector<std::int32_t> places(static_cast<size_t>(n));
        std::int32_t next = 0;
        for (size_t k = 0; k < size_t(n); ++k) {
            next += starts_group[k] ? next % 2 : 0;
            places[k] = next++;
        }
        next += next % 2;
        node_size_ = 2 * Index(next) <= 3 * n ? 2 : 1;
        num_places_ = node_size_ == 2 ? next : n;
        places_.resize(size_t(n));
        for (size_t k = 0; k < size_t(n); ++k) {
            if (node_size_ == 1) {
                places[k] = static_cast<std::int32_t>(k);
            }
            places_[size_t(analysis.order()[k])] = places[k];
        }
        return places;
    }

    static void check_pivots(const SupernodalCholesky<double>& cholesky, const Front& front,
                             const Eigen::SparseMatrix<double>& A, std::string_view what) {
        for (Index k = 0; k < front.width; ++k) {
            const double pivot = cholesky.panel(front)(k, k);
            const std::int32_t row = cholesky.analysis()->order()[size_t(front.first_pivot + k)];
            const double diagonal = A.coeff(row, row);
            require(pivot * pivot > smallest_relative_pivot * diagonal, what, ": pivot of row ", row, " = ",
                    pivot * pivot, " of ", diagonal, ", the matrix is singular to rounding");
        }
    }

    void store(const SupernodalCholesky<double>& cholesky, const Front& front,
               const std::vector<std::int32_t>& places) {
        using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, widest, widest>;
        const Eigen::Map<const MatrixX<double>> panel = cholesky.panel(front);
        const auto place_of = [&](Index row) {
            const Index pivot = row < front.width ? front.first_pivot + row
                                                  : cholesky.analysis()->rows(front)[size_t(row - front.width)];
            return places[size_t(pivot)];
        };
        for (Index begin = 0, end = 0; begin < front.width; begin = end) {
            const std::int32_t first = place_of(begin), size = node_size_;
            const bool is_wide = place_of(front.width - 1) >= first + widest - size;
            const std::int32_t columns = is_wide ? widest : size;
            const auto copy_row = [&](Index row, auto to) {
                for (Index column = begin; column < std::min(end, row + 1); ++column) {
                    to(place_of(column) - first) = panel(row, column);
                }
            };
            Block D = Block::Identity(columns, columns);
            while (end < front.width && place_of(end) < first + columns) {
                ++end;
            }
            for (Index row = begin; row < end; ++row) {
                copy_row(row, D.row(place_of(row) - first));
            }
            append(Block(D.template triangularView<Eigen::Lower>().solve(Block::Identity(columns, columns))),
                   diagonals_);
            strips_.push_back({first, columns, 0});
            for (Index row = end; row < front.height;) {
                const std::int32_t node = place_of(row) / size;
                Block L = Block::Zero(size, columns);
                for (; row < front.height && place_of(row) / size == node; ++row) {
                    copy_row(row, L.row(place_of(row) % size));
                }
                if (!L.isZero(0.0)) {
                    ++strips_.back().num_blocks;
                    rows_.push_back(node * size);
                    append(L, values_);
                }
            }
        }
    }

    template <class Block>
    static void append(const Block& block, std::vector<Scalar>& values) {
        for (const double value : block.template reshaped<Eigen::RowMajor>()) {
            values.push_back(Scalar(value));
        }
    }

    static Eigen::Map<Lanes> lanes(Scalar* y, Index place) { return Eigen::Map<Lanes>(y + 4 * place); }

    /// Where in the factor a solve has come to.
    struct Cursor {
        const Scalar* diagonal;
        const Scalar* block;
        const std::int32_t* row;

        template <int rows, int columns>
        void move(Index strips, Index blocks) {
            diagonal += strips * columns * columns;
            block += blocks * rows * columns;
            row += blocks;
        }
    };

    template <int rows>
    void solve(Scalar* y) const {
        Cursor at{diagonals_.data(), values_.data(), rows_.data()};
        for (const Strip& strip : strips_) {
            strip.columns == widest ? eliminate<rows, widest>(strip, at, y) : eliminate<rows, rows>(strip, at, y);
        }
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
        for (Index k = 0; k < strip.num_blocks; ++k, L += rows * columns) {
            for (int r = 0; r < rows; ++r) {
                Lanes sum = lanes(y, at.row[k] + r);
                for (int c = 0; c < columns; ++c) {
                    sum -= L[columns * r + c] * a[size_t(c)];
                }
                lanes(y, at.row[k] + r) = sum;
            }
        }
        at.template move<rows, columns>(1, strip.num_blocks);
    }

    template <int rows, int columns>
    static void substitute(const Strip& strip, Cursor& at, Scalar* y) {
        at.template move<rows, columns>(-1, -strip.num_blocks);
        // a sum for each entry of a block, that none waits for another; backwards through memory all along
        std::array<std::array<Lanes, size_t(columns)>, size_t(rows)> sums;
        for (auto& of_row : sums) {
            of_row.fill(Lanes::Zero());
        }
        const Scalar* L = at.block + rows * columns * strip.num_blocks;
        for (Index k = strip.num_blocks; k-- > 0;) {
            L -= rows * columns;
            for (int r = 0; r < rows; ++r) {
                const Lanes y_r = lanes(y, at.row[k] + r);
                for (int c = 0; c < columns; ++c) {
                    sums[size_t(r)][size_t(c)] += L[columns * r + c] * y_r;
                }
            }
        }
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

    std::int32_t node_size_ = 1;
    Index num_places_ = 0;
    std::vector<std::int32_t> places_;
    std::vector<Strip> strips_;
    std::vector<std::int32_t> rows_;  // first place of each block
    std::vector<Scalar> values_;      // blocks by rows
    std::vector<Scalar> diagonals_;   // inverse diagonal blocks by rows
};

}  // namespace softtissue
