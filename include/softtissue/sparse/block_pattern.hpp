// SPDX-License-Identifier: MIT
/// @file
/// Which pairs of vertices interact: the fixed sparsity pattern of a symmetric matrix of 3x3 blocks.
///
/// What        for each vertex the sorted list of its neighbours, itself included. Built once per mesh.
/// Layout      compressed columns; `rank(j, i)` is the place of block (i, j) in column j.
/// Tests       tests/unit/sparse/block_pattern_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

class BlockPattern {
public:
    BlockPattern() = default;

    /// `neighbours[j]` are the rows of column j in any order, repetitions allowed; the diagonal is always added.
    explicit BlockPattern(std::vector<std::vector<std::int32_t>> neighbours) {
        checked_index(Index(neighbours.size()), "block pattern: columns");
        offsets_.reserve(neighbours.size() + 1);
        for (size_t j = 0; j < neighbours.size(); ++j) {
            std::vector<std::int32_t>& column = neighbours[j];
            column.push_back(static_cast<std::int32_t>(j));
            std::sort(column.begin(), column.end());
            column.erase(std::unique(column.begin(), column.end()), column.end());
            rows_.insert(rows_.end(), column.begin(), column.end());
            offsets_.push_back(static_cast<Index>(rows_.size()));
        }
    }

    Index num_columns() const { return static_cast<Index>(offsets_.size()) - 1; }
    Index num_blocks() const { return offsets_.back(); }

    /// Number of blocks before column j.
    Index offset(Index j) const { return offsets_[size_t(j)]; }

    /// Rows of column j, ascending.
    std::span<const std::int32_t> rows(Index j) const {
        return {rows_.data() + offsets_[size_t(j)], rows_.data() + offsets_[size_t(j) + 1]};
    }

    /// Place of row i in column j, which must contain it.
    std::int32_t rank(Index j, std::int32_t i) const {
        const std::span<const std::int32_t> column = rows(j);
        const auto place = std::lower_bound(column.begin(), column.end(), i);
        SOFTTISSUE_ASSERT(place != column.end() && *place == i);
        return static_cast<std::int32_t>(place - column.begin());
    }

    friend bool operator==(const BlockPattern&, const BlockPattern&) = default;

private:
    std::vector<Index> offsets_{0};
    std::vector<std::int32_t> rows_;
};

}  // namespace softtissue
