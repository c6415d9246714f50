// SPDX-License-Identifier: MIT
/// @file
/// A sparse Cholesky factor that is kept to solve for three right-hand sides again and again.
///
/// What        L of P A P^T = L L^T in blocks of nodes; both triangular solves in place, without allocation.
/// Shapes      y 4 x num_places(): one column per unknown, its right-hand sides side by side, the fourth free; unknown u is column
///             place(u). Columns that belong to no unknown must be finite and stay as they are.
/// Why         a solve reads L twice: right-hand sides side by side cost hardly more than one; two unknowns with the same
///             neighbours (both free vertices of a column of prisms) need one index for four entries; a factor computed in
///             double and kept in float costs half the bytes and loses only the last rounding
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
        const std::vector<std::int32_t> node_of_pivot = make_nodes(*cholesky.analysis());
        for (const Front& front : cholesky.analysis()->fronts()) {
            check_pivots(cholesky, front, A, what);
            if (node_size_ == 2) {
                store<2>(cholesky, front, node_of_pivot);
            } else {
                store<1>(cholesky, front, node_of_pivot);
            }
        }
    }

    /// Unknowns.
    Index size() const { return Index(places_.size()); }
    /// Columns of right-hand sides.
    Index num_places() const { return node_size_ * (Index(offsets_.size()) - 1); }
    /// Which column each unknown is.
    std::int32_t place(Index unknown) const { return places_[size_t(unknown)]; }

    /// Stored entries of L, without the diagonal blocks.
    Index num_entries() const { return Index(values_.size()); }

    /// y = (L L^T)^-1 y.
    void solve_in_place(Eigen::Ref<RightHandSides> y) const {
        SOFTTISSUE_ASSERT(y.cols() == num_places());
        if (node_size_ == 2) {
            solve_pairs(y.data());
        } else {
            solve_single(y.data());
        }
    }

private:
    using Lanes = Eigen::Array<Scalar, 4, 1>;

    /// A pivot of a regular matrix keeps far more than rounding of its diagonal entry.
    static constexpr double smallest_relative_pivot = 1e4 * std::numeric_limits<double>::epsilon();

    /// Pairs of pivots within a group, if most unknowns find a partner.
    std::vector<std::int32_t> make_nodes(const SupernodalAnalysis& analysis) {
        const Index n = analysis.num_unknowns();
        std::vector<bool> starts_group(size_t(n), false);
        for (const std::int32_t pivot : analysis.group_pivots()) {
            starts_group[size_t(pivot)] = true;
        }
        std::vector<std::int32_t> node_of_pivot(static_cast<size_t>(n)), places_of_pivots(static_cast<size_t>(n));
        std::int32_t node = -1;
        for (size_t k = 0, in_node = 0; k < size_t(n); ++k) {
            const bool continues = in_node == 1 && !starts_group[k];
            in_node = continues ? 2 : 1;
            node += continues ? 0 : 1;
            node_of_pivot[k] = node;
            places_of_pivots[k] = 2 * node + std::int32_t(in_node) - 1;
        }
        node_size_ = 4 * Index(node + 1) <= 3 * n ? 2 : 1;
        places_.resize(size_t(n));
        for (size_t k = 0; k < size_t(n); ++k) {
            if (node_size_ == 1) {
                node_of_pivot[k] = places_of_pivots[k] = static_cast<std::int32_t>(k);
            }
            places_[size_t(analysis.order()[k])] = places_of_pivots[k];
        }
        return node_of_pivot;
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

    template <int node_size>
    void store(const SupernodalCholesky<double>& cholesky, const Front& front,
               const std::vector<std::int32_t>& node_of_pivot) {
        using Block = Eigen::Matrix<double, node_size, node_size>;
        const Eigen::Map<const MatrixX<double>> panel = cholesky.panel(front);
        const auto node_of = [&](Index row) {
            const Index pivot = row < front.width ? front.first_pivot + row
                                                  : cholesky.analysis()->rows(front)[size_t(row - front.width)];
            return node_of_pivot[size_t(pivot)];
        };
        const auto count_alike = [&](Index row) {
            return node_size == 2 && row + 1 < front.height && node_of(row + 1) == node_of(row) ? Index(2) : Index(1);
        };
        for (Index column = 0, width = 0; column < front.width; column += width) {
            width = count_alike(column);
            Block D = Block::Identity();
            D.topLeftCorner(width, width) = panel.block(column, column, width, width);
            append(Block(D.template triangularView<Eigen::Lower>().solve(Block::Identity())), diagonals_);
            for (Index row = column + width, height = 0; row < front.height; row += height) {
                height = count_alike(row);
                Block L = Block::Zero();
                L.topLeftCorner(height, width) = panel.block(row, column, height, width);
                if (!L.isZero(0.0)) {
                    rows_.push_back(node_of(row));
                    append(L, values_);
                }
            }
            offsets_.push_back(rows_.size());
        }
    }

    template <class Block>
    static void append(const Block& block, std::vector<Scalar>& values) {
        for (const double value : block.template reshaped<Eigen::RowMajor>()) {
            values.push_back(Scalar(value));
        }
    }

    static Eigen::Map<Lanes> lanes(Scalar* y, Index place) { return Eigen::Map<Lanes>(y + 4 * place); }

    void solve_pairs(Scalar* y) const {
        const Index num_nodes = Index(offsets_.size()) - 1;
        for (Index j = 0; j < num_nodes; ++j) {
            const Scalar* const D = diagonals_.data() + 4 * j;
            const Lanes b = D[2] * lanes(y, 2 * j) + D[3] * lanes(y, 2 * j + 1);
            const Lanes a = D[0] * lanes(y, 2 * j);
            lanes(y, 2 * j) = a;
            lanes(y, 2 * j + 1) = b;
            for (size_t k = offsets_[size_t(j)]; k < offsets_[size_t(j) + 1]; ++k) {
                const Scalar* const L = values_.data() + 4 * k;
                const Index i = 2 * Index(rows_[k]);
                lanes(y, i) -= L[0] * a + L[1] * b;
                lanes(y, i + 1) -= L[2] * a + L[3] * b;
            }
        }
        for (Index j = num_nodes; j-- > 0;) {
            const Scalar* const D = diagonals_.data() + 4 * j;
            // four sums, that none waits for another
            std::array<Lanes, 4> sums{Lanes::Zero(), Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
            for (size_t k = offsets_[size_t(j)]; k < offsets_[size_t(j) + 1]; ++k) {
                const Scalar* const L = values_.data() + 4 * k;
                const Lanes upper = lanes(y, 2 * Index(rows_[k]));
                const Lanes lower = lanes(y, 2 * Index(rows_[k]) + 1);
                sums[0] += L[0] * upper;
                sums[1] += L[1] * upper;
                sums[2] += L[2] * lower;
                sums[3] += L[3] * lower;
            }
            const Lanes a = lanes(y, 2 * j) - (sums[0] + sums[2]);
            const Lanes b = lanes(y, 2 * j + 1) - (sums[1] + sums[3]);
            lanes(y, 2 * j) = D[0] * a + D[2] * b;
            lanes(y, 2 * j + 1) = D[3] * b;
        }
    }

    void solve_single(Scalar* y) const {
        const Index num_nodes = Index(offsets_.size()) - 1;
        for (Index j = 0; j < num_nodes; ++j) {
            const Lanes a = diagonals_[size_t(j)] * lanes(y, j);
            lanes(y, j) = a;
            for (size_t k = offsets_[size_t(j)]; k < offsets_[size_t(j) + 1]; ++k) {
                lanes(y, rows_[k]) -= values_[k] * a;
            }
        }
        for (Index j = num_nodes; j-- > 0;) {
            Lanes a = lanes(y, j);
            for (size_t k = offsets_[size_t(j)]; k < offsets_[size_t(j) + 1]; ++k) {
                a -= values_[k] * lanes(y, rows_[k]);
            }
            lanes(y, j) = diagonals_[size_t(j)] * a;
        }
    }

    Index node_size_ = 1;
    std::vector<std::int32_t> places_;
    std::vector<size_t> offsets_{0};
    std::vector<std::int32_t> rows_;  // nodes
    std::vector<Scalar> values_;      // blocks by rows
    std::vector<Scalar> diagonals_;   // inverse diagonal blocks by rows
};

}  // namespace softtissue
