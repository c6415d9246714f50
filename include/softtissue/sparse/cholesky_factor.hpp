// SPDX-License-Identifier: MIT
/// @file
/// A sparse Cholesky factor that is kept to solve for three right-hand sides again and again.
///
/// What        L of P A P^T = L L^T in blocks of nodes; both triangular solves in place, without allocation.
/// Shapes      y 4 x num_places(): one column per unknown, its right-hand sides side by side, the fourth free; unknown u is column
///             place(u). Columns that belong to no unknown must be finite; a solve may change them.
/// Why         a solve reads L twice: right-hand sides side by side cost hardly more than one; two unknowns with the same
///             neighbours (both free vertices of a column of prisms) and the next two need one index for eight entries; a
///             factor computed in double and kept in float costs half the bytes and loses only the last rounding
/// Threads     two: each takes subtrees of the elimination tree and has a copy of the rows above them, which are
///             added in a fixed order; then the top, on the calling thread, and the subtrees again. Same bits for every executor.
/// Refuses     a matrix that is not positive definite to rounding (InvalidInput names row, pivot and size).
/// Cost        2 reads of L, 16 flop per entry
/// Tests       tests/unit/sparse/cholesky_factor_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/factor_strips.hpp>
#include <softtissue/sparse/subtree_parts.hpp>
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
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
        const SupernodalAnalysis& analysis = *cholesky.analysis();
        const std::vector<std::int32_t> parts = parts_of(analysis);
        const std::vector<std::int32_t> places = place_pivots(analysis, parts);
        strips_.assign(size_t(num_parts + 1), FactorStrips<Scalar>(int(node_size_)));
        for (size_t f = 0; f < parts.size(); ++f) {
            const Front& front = analysis.fronts()[f];
            check_pivots(cholesky, front, A, what);
            store(cholesky, front, parts[f], places);
        }
    }

    /// Unknowns.
    Index size() const { return Index(places_.size()); }
    /// Columns of right-hand sides.
    Index num_places() const { return num_places_; }
    /// Which column each unknown is.
    std::int32_t place(Index unknown) const { return places_[size_t(unknown)]; }

    /// Stored entries of L, without the diagonal blocks.
    Index num_entries() const {
        Index sum = 0;
        for (const FactorStrips<Scalar>& strips : strips_) {
            sum += strips.num_entries();
        }
        return sum;
    }
    /// What a solve reads of L, each of two times.
    Index num_bytes() const {
        Index sum = 0;
        for (const FactorStrips<Scalar>& strips : strips_) {
            sum += strips.num_bytes();
        }
        return sum;
    }

    /// y = (L L^T)^-1 y.
    template <Executor E = SequentialExecutor>
    void solve_in_place(Eigen::Ref<RightHandSides> y, const E& executor = {}) const {
        SOFTTISSUE_ASSERT(y.cols() == num_places());
        executor.for_each_range(num_parts, [&](Index begin, Index end) {
            for (Index part = begin; part < end; ++part) {
                copy_of_top(y, part).setZero();
                strips_[size_t(part)].eliminate(y.data());
            }
        });
        for (Index part = 0; part < num_parts; ++part) {
            y.rightCols(num_top_) += copy_of_top(y, part);
        }
        strips_.back().eliminate(y.data());
        strips_.back().substitute(y.data());
        executor.for_each_range(num_parts, [&](Index begin, Index end) {
            for (Index part = begin; part < end; ++part) {
                copy_of_top(y, part) = y.rightCols(num_top_);
                strips_[size_t(part)].substitute(y.data());
            }
        });
    }

private:
    using Block = typename FactorStrips<Scalar>::Block;

    /// Four parts leave a fifth of a limb to the top: no gain on four threads, a loss on two.
    static constexpr Index num_parts = 2;
    /// Below this many entries a thread is not worth waking.
    static constexpr double least_work = 5e4;

    /// A pivot of a regular matrix keeps far more than rounding of its diagonal entry.
    static constexpr double smallest_relative_pivot = 1e4 * std::numeric_limits<double>::epsilon();

    auto copy_of_top(Eigen::Ref<RightHandSides>& y, Index part) const {
        return y.middleCols(copies_of_top_[size_t(part)], num_top_);
    }

    /// The part of each front, num_parts for the top.
    static std::vector<std::int32_t> parts_of(const SupernodalAnalysis& analysis) {
        const std::vector<Front>& fronts = analysis.fronts();
        std::vector<std::int32_t> parents(fronts.size(), -1);
        std::vector<double> work(fronts.size());
        double total = 0;
        for (size_t f = 0; f < fronts.size(); ++f) {
            work[f] = double(fronts[f].height * fronts[f].width);
            total += work[f];
            for (const std::int32_t child : analysis.children(fronts[f])) {
                parents[size_t(child)] = static_cast<std::int32_t>(f);
            }
        }
        return total < least_work ? std::vector<std::int32_t>(fronts.size(), std::int32_t(num_parts))
                                  : make_subtree_parts(parents, work, int(num_parts));
    }

    /// Pairs of pivots within a group, if most unknowns find a partner; the pivots of a part together, then its copy of the top.
    std::vector<std::int32_t> place_pivots(const SupernodalAnalysis& analysis, const std::vector<std::int32_t>& parts) {
        const Index n = analysis.num_unknowns();
        std::vector<bool> starts_group(size_t(n), false);
        for (const std::int32_t pivot : analysis.group_pivots()) {
            starts_group[size_t(pivot)] = true;
        }
        std::vector<std::int32_t> places(static_cast<size_t>(n));
        const auto place_part = [&](Index part, std::int32_t next) {
            for (size_t f = 0; f < parts.size(); ++f) {
                const Front& front = analysis.fronts()[f];
                for (Index k = front.first_pivot; parts[f] == part && k < front.first_pivot + front.width; ++k) {
                    next += node_size_ == 2 && starts_group[size_t(k)] ? next % 2 : 0;
                    places[size_t(k)] = next++;
                }
            }
            return next + (node_size_ == 2 ? next % 2 : 0);
        };
        node_size_ = 2;
        Index num_paired = 0;
        for (Index part = 0; part <= num_parts; ++part) {
            num_paired += num_top_ = place_part(part, 0);
        }
        if (2 * num_paired > 3 * n) {
            node_size_ = 1;
            num_top_ = place_part(num_parts, 0);
        }
        checked_index(2 * (n + num_parts * num_top_), "Cholesky factor: places of unknowns");
        std::int32_t next = 0;
        for (Index part = 0; part < num_parts; ++part) {
            next = place_part(part, next);
            copies_of_top_.push_back(next);
            next += static_cast<std::int32_t>(num_top_);
        }
        num_places_ = place_part(num_parts, next);
        places_.resize(size_t(n));
        for (size_t k = 0; k < size_t(n); ++k) {
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

    void store(const SupernodalCholesky<double>& cholesky, const Front& front, std::int32_t part,
               const std::vector<std::int32_t>& places) {
        constexpr std::int32_t widest = FactorStrips<Scalar>::widest;
        FactorStrips<Scalar>& strips = strips_[size_t(part)];
        const Eigen::Map<const MatrixX<double>> panel = cholesky.panel(front);
        const std::int32_t first_of_top = static_cast<std::int32_t>(num_places_ - num_top_);
        const auto place_of = [&](Index row) {
            const Index pivot = row < front.width ? front.first_pivot + row
                                                  : cholesky.analysis()->rows(front)[size_t(row - front.width)];
            const std::int32_t place = places[size_t(pivot)];
            return part == num_parts || place < first_of_top ? place
                                                             : place - first_of_top + copies_of_top_[size_t(part)];
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
            strips.add_strip(first, D.template triangularView<Eigen::Lower>().solve(Block::Identity(columns, columns)));
            for (Index row = end; row < front.height;) {
                const std::int32_t node = place_of(row) / size;
                Block L = Block::Zero(size, columns);
                for (; row < front.height && place_of(row) / size == node; ++row) {
                    copy_row(row, L.row(place_of(row) % size));
                }
                if (!L.isZero(0.0)) {
                    strips.add_block(node * size, L);
                }
            }
        }
    }

    std::int32_t node_size_ = 1;
    Index num_places_ = 0;
    Index num_top_ = 0;  // places of the top, which are the last
    std::vector<std::int32_t> places_;
    std::vector<std::int32_t> copies_of_top_;   // first place of each part's
    std::vector<FactorStrips<Scalar>> strips_;  // of each part, then of the top
};

}  // namespace softtissue
