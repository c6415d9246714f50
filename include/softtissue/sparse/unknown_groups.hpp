// SPDX-License-Identifier: MIT
/// @file
/// Unknowns that share their neighbours, taken together: what orders and eliminates a sparse matrix by vertices, not components.
///
/// What        consecutive unknowns whose columns have the same pattern form a group (the three components of a vertex, the
///             vertices of a column of prisms, ...); the graph of the groups, which is smaller by the square of their size.
/// Valid       any symmetric pattern, of which the lower triangle is read; diagonal entries count as present.
/// Cost        proportional to the entries
/// Tests       tests/unit/sparse/unknown_groups_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/sparse/block_pattern.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

class UnknownGroups {
public:
    template <class Scalar>
    explicit UnknownGroups(const Eigen::SparseMatrix<Scalar>& A) {
        std::vector<std::vector<std::int32_t>> neighbours(size_t(A.cols()));
        for (Index j = 0; j < A.outerSize(); ++j) {
            for (typename Eigen::SparseMatrix<Scalar>::InnerIterator entry(A, j); entry; ++entry) {
                if (entry.row() > j) {
                    neighbours[size_t(j)].push_back(static_cast<std::int32_t>(entry.row()));
                    neighbours[size_t(entry.row())].push_back(static_cast<std::int32_t>(j));
                }
            }
        }
        group_alike(BlockPattern(std::move(neighbours)));
    }

    Index num_groups() const { return Index(begins_.size()) - 1; }
    Index num_unknowns() const { return begins_.back(); }

    /// First unknown of a group; its unknowns are consecutive.
    std::int32_t begin(Index group) const { return begins_[size_t(group)]; }
    std::int32_t size(Index group) const { return begins_[size_t(group) + 1] - begins_[size_t(group)]; }

    /// Which groups interact, each with itself included.
    const BlockPattern& graph() const { return graph_; }

private:
    void group_alike(const BlockPattern& pattern) {
        std::vector<std::int32_t> group_of(size_t(pattern.num_columns()));
        for (Index j = 0; j < pattern.num_columns(); ++j) {
            const bool is_alike = j > 0 && std::ranges::equal(pattern.rows(j), pattern.rows(j - 1));
            if (!is_alike) {
                begins_.push_back(static_cast<std::int32_t>(j));
            }
            group_of[size_t(j)] = static_cast<std::int32_t>(begins_.size()) - 1;
        }
        std::vector<std::vector<std::int32_t>> neighbours(begins_.size());
        for (size_t g = 0; g < begins_.size(); ++g) {
            for (const std::int32_t row : pattern.rows(begins_[g])) {
                if (neighbours[g].empty() || neighbours[g].back() != group_of[size_t(row)]) {
                    neighbours[g].push_back(group_of[size_t(row)]);
                }
            }
        }
        begins_.push_back(static_cast<std::int32_t>(pattern.num_columns()));
        graph_ = BlockPattern(std::move(neighbours));
    }

    std::vector<std::int32_t> begins_;
    BlockPattern graph_;
};

}  // namespace softtissue
