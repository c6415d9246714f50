// SPDX-License-Identifier: MIT
/// @file
/// Lists of indices, one per row, in compressed storage.
///
/// What        row(i) is a span of ascending or insertion-ordered 32-bit indices; rows have any length.
/// Tests       tests/unit/mesh/adjacency_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

class Adjacency {
public:
    Adjacency() = default;

    /// From (row, item) pairs; items keep the order of `pairs` within their row.
    Adjacency(Index num_rows, const std::vector<std::pair<std::int32_t, std::int32_t>>& pairs)
        : offsets_(size_t(num_rows) + 1, 0), items_(pairs.size()) {
        for (const auto& [row, item] : pairs) {
            ++offsets_[size_t(row) + 1];
        }
        for (size_t i = 1; i < offsets_.size(); ++i) {
            offsets_[i] += offsets_[i - 1];
        }
        std::vector<size_t> next(offsets_.begin(), offsets_.end() - 1);
        for (const auto& [row, item] : pairs) {
            items_[next[size_t(row)]++] = item;
        }
    }

    Index num_rows() const { return static_cast<Index>(offsets_.size()) - 1; }

    std::span<const std::int32_t> row(Index i) const {
        return {items_.data() + offsets_[size_t(i)], items_.data() + offsets_[size_t(i) + 1]};
    }

private:
    std::vector<size_t> offsets_{0};
    std::vector<std::int32_t> items_;
};

}  // namespace softtissue
