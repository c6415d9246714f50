// SPDX-License-Identifier: MIT
/// @file
/// Everything about a sparse Cholesky factorisation that the pattern of the matrix decides.
///
/// What        the order of the pivots and a sequence of fronts. A front is the dense lower trapezoid of the columns that a
///             supernode eliminates, over all their rows, and the update that it leaves to its parent on the rows below.
/// Reuse       matrices of one pattern share one analysis, which is never changed after construction.
/// Valid       a square matrix in compressed form, of which the lower triangle is read. Refuses other matrices (InvalidInput).
/// Source      Duff, Reid 1983 (multifrontal method)
/// Cost        some tens of factorisations of the pattern's groups, see unknown_groups.hpp; about one numeric factorisation
/// Tests       tests/unit/sparse/supernodal_analysis_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/sparse/minimum_degree_order.hpp>
#include <softtissue/sparse/supernodes.hpp>
#include <softtissue/sparse/unknown_groups.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

/// Part of a list: [begin, end).
struct IndexRange {
    Index begin = 0, end = 0;
};

struct Front {
    Index first_pivot = 0;
    Index width = 0;      ///< pivots
    Index height = 0;     ///< rows: pivots first, then those below
    Index panel = 0;      ///< place of the height x width panel among the values of the factor, column-major
    Index rows = 0;       ///< place of the height - width rows below in SupernodalAnalysis::rows()
    int stack = 0;        ///< which of two stacks holds the update
    Index update = 0;     ///< place of the square update there, column-major, lower triangle
    IndexRange children;  ///< in SupernodalAnalysis::children()
    IndexRange runs;      ///< in SupernodalAnalysis::runs(): where the update goes in the parent
    IndexRange entries;   ///< in SupernodalAnalysis::entries()

    Index num_rows_below() const { return height - width; }
};

/// Consecutive rows of an update that are consecutive rows of the parent's front.
struct FrontRun {
    std::int32_t row, parent_row, length;
};

/// A value of the matrix and its place in the panel.
struct FrontEntry {
    std::int32_t source, panel_place;
};

class SupernodalAnalysis {
public:
    template <class Scalar>
    explicit SupernodalAnalysis(const Eigen::SparseMatrix<Scalar>& A) : num_matrix_entries_(A.nonZeros()) {
        require(A.rows() == A.cols() && A.isCompressed(), "sparse Cholesky: a matrix of ", A.rows(), " rows and ",
                A.cols(), " columns, expected a square one in compressed form");
        const UnknownGroups groups(A);
        std::vector<std::int32_t> weights(size_t(groups.num_groups()));
        for (Index g = 0; g < groups.num_groups(); ++g) {
            weights[size_t(g)] = groups.size(g);
        }
        const std::vector<Supernode> supernodes =
            make_supernodes(groups.graph(), minimum_degree_order(groups.graph()), weights);
        order_pivots(supernodes, groups);
        lay_out_fronts(supernodes, groups);
        lay_out_updates(supernodes);
        find_entries(A);
    }

    Index num_unknowns() const { return Index(order_.size()); }
    /// Entries of the analysed matrix, both triangles as far as they are stored.
    Index num_matrix_entries() const { return num_matrix_entries_; }
    /// Values to store, zeros of merged supernodes and upper triangles of panels included.
    Index num_values() const { return num_values_; }
    /// Values of the two stacks of updates.
    std::array<Index, 2> stack_sizes() const { return stack_sizes_; }
    Index largest_height() const { return largest_height_; }

    /// Which unknown each pivot is.
    const std::vector<std::int32_t>& order() const { return order_; }

    /// First pivot of each group of unknowns with the same neighbours; the others follow.
    const std::vector<std::int32_t>& group_pivots() const { return first_pivot_of_group_; }

    /// Children come before their parents.
    const std::vector<Front>& fronts() const { return fronts_; }
    std::span<const std::int32_t> rows(const Front& front) const {
        return {rows_.data() + front.rows, size_t(front.num_rows_below())};
    }
    std::span<const std::int32_t> children(const Front& front) const { return part(children_, front.children); }
    std::span<const FrontRun> runs(const Front& front) const { return part(runs_, front.runs); }
    std::span<const FrontEntry> entries(const Front& front) const { return part(entries_, front.entries); }

private:
    template <class T>
    static std::span<const T> part(const std::vector<T>& list, IndexRange range) {
        return {list.data() + range.begin, list.data() + range.end};
    }

    void order_pivots(const std::vector<Supernode>& supernodes, const UnknownGroups& groups) {
        first_pivot_of_group_.resize(size_t(groups.num_groups()));
        order_.reserve(size_t(groups.num_unknowns()));
        for (const Supernode& supernode : supernodes) {
            for (const std::int32_t g : supernode.columns) {
                first_pivot_of_group_[size_t(g)] = static_cast<std::int32_t>(order_.size());
                for (std::int32_t k = 0; k < groups.size(g); ++k) {
                    order_.push_back(groups.begin(g) + k);
                }
            }
        }
    }

    void lay_out_fronts(const std::vector<Supernode>& supernodes, const UnknownGroups& groups) {
        fronts_.resize(supernodes.size());
        for (size_t s = 0; s < supernodes.size(); ++s) {
            Front& front = fronts_[s];
            front.first_pivot = first_pivot_of_group_[size_t(supernodes[s].columns.front())];
            for (const std::int32_t g : supernodes[s].columns) {
                front.width += groups.size(g);
            }
            front.rows = Index(rows_.size());
            for (const std::int32_t g : supernodes[s].rows) {
                for (std::int32_t k = 0; k < groups.size(g); ++k) {
                    rows_.push_back(first_pivot_of_group_[size_t(g)] + k);
                }
            }
            front.height = front.width + Index(rows_.size()) - front.rows;
            checked_index(front.height * front.width, "sparse Cholesky: numbers of a front");
            front.panel = num_values_;
            num_values_ += front.height * front.width;
            largest_height_ = std::max(largest_height_, front.height);
        }
    }

    /// An update lies on the stack of its depth's parity. When a front is computed, its children's updates are on top of the
    /// other stack, so its own grows without moving them.
    void lay_out_updates(const std::vector<Supernode>& supernodes) {
        std::vector<std::vector<std::int32_t>> children(fronts_.size());
        for (size_t f = fronts_.size(); f-- > 0;) {
            const std::int32_t parent = supernodes[f].parent;
            fronts_[f].stack = parent == Supernode::no_parent ? 0 : 1 - fronts_[size_t(parent)].stack;
        }
        std::array<Index, 2> top{0, 0};
        std::vector<std::int32_t> row_in_front(order_.size());
        for (size_t f = 0; f < fronts_.size(); ++f) {
            Front& front = fronts_[f];
            front.children.begin = Index(children_.size());
            children_.insert(children_.end(), children[f].begin(), children[f].end());
            front.children.end = Index(children_.size());
            number_rows(front, row_in_front);
            for (const std::int32_t c : children[f]) {
                find_runs(fronts_[size_t(c)], row_in_front);
            }
            if (supernodes[f].parent != Supernode::no_parent) {
                children[size_t(supernodes[f].parent)].push_back(static_cast<std::int32_t>(f));
            }
            Index& own = top[size_t(front.stack)];
            front.update = own;
            own += front.num_rows_below() * front.num_rows_below();
            stack_sizes_[size_t(front.stack)] = std::max(stack_sizes_[size_t(front.stack)], own);
            if (!children[f].empty()) {
                top[size_t(1 - front.stack)] = fronts_[size_t(children[f].front())].update;
            }
        }
    }

    void number_rows(const Front& front, std::vector<std::int32_t>& row_in_front) const {
        for (Index k = 0; k < front.width; ++k) {
            row_in_front[size_t(front.first_pivot + k)] = static_cast<std::int32_t>(k);
        }
        std::int32_t next = static_cast<std::int32_t>(front.width);
        for (const std::int32_t row : rows(front)) {
            row_in_front[size_t(row)] = next++;
        }
    }

    void find_runs(Front& child, const std::vector<std::int32_t>& row_in_parent) {
        child.runs.begin = Index(runs_.size());
        std::int32_t k = 0;
        for (const std::int32_t row : rows(child)) {
            const std::int32_t parent_row = row_in_parent[size_t(row)];
            const bool continues = k > 0 && parent_row == runs_.back().parent_row + runs_.back().length;
            if (continues) {
                ++runs_.back().length;
            } else {
                runs_.push_back({k, parent_row, 1});
            }
            ++k;
        }
        child.runs.end = Index(runs_.size());
    }

    template <class Scalar>
    void find_entries(const Eigen::SparseMatrix<Scalar>& A) {
        struct Entry {
            std::int32_t source, row;
        };
        std::vector<std::int32_t> pivot_of(order_.size());
        for (size_t k = 0; k < order_.size(); ++k) {
            pivot_of[size_t(order_[k])] = static_cast<std::int32_t>(k);
        }
        std::vector<std::vector<Entry>> by_pivot(order_.size());
        for (Index j = 0; j < A.outerSize(); ++j) {
            for (int e = A.outerIndexPtr()[j]; e < A.outerIndexPtr()[j + 1]; ++e) {
                const int i = A.innerIndexPtr()[e];
                if (i >= j) {
                    const auto [column, row] = std::minmax(pivot_of[size_t(i)], pivot_of[size_t(j)]);
                    by_pivot[size_t(column)].push_back({e, row});
                }
            }
        }
        std::vector<std::int32_t> row_in_front(order_.size());
        for (Front& front : fronts_) {
            number_rows(front, row_in_front);
            front.entries.begin = Index(entries_.size());
            for (Index k = 0; k < front.width; ++k) {
                for (const Entry& entry : by_pivot[size_t(front.first_pivot + k)]) {
                    const Index place = k * front.height + row_in_front[size_t(entry.row)];
                    entries_.push_back({entry.source, static_cast<std::int32_t>(place)});
                }
            }
            front.entries.end = Index(entries_.size());
        }
    }

    Index num_matrix_entries_ = 0, num_values_ = 0, largest_height_ = 0;
    std::array<Index, 2> stack_sizes_{0, 0};
    std::vector<std::int32_t> order_, first_pivot_of_group_, rows_, children_;
    std::vector<Front> fronts_;
    std::vector<FrontRun> runs_;
    std::vector<FrontEntry> entries_;
};

}  // namespace softtissue
