// SPDX-License-Identifier: MIT
/// @file
/// A reproducible random order of visits.
///
/// What        ShuffledOrder: the numbers 0 .. n - 1, in another order at every call.
/// Why         a sweep over vertices in their own order carries changes along the numbering; the same bits on every platform
///             ask for an own generator.
/// Source      linear congruential generator: Knuth, TAOCP 2, section 3.3.4; shuffle: Durstenfeld 1964
/// Tests       tests/unit/anatomy/shuffled_order_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace softtissue {

class ShuffledOrder {
public:
    explicit ShuffledOrder(Index count) : order_(size_t(count)) { std::iota(order_.begin(), order_.end(), 0); }

    /// The order of the next sweep; valid until the next call.
    const std::vector<std::int32_t>& next() {
        for (size_t i = order_.size(); i > 1; --i) {
            state_ = state_ * 6364136223846793005U + 1442695040888963407U;
            const std::uint64_t k = ((state_ >> 32U) * std::uint64_t(i)) >> 32U;  // the high bits are the random ones
            std::swap(order_[i - 1], order_[size_t(k)]);
        }
        return order_;
    }

private:
    std::vector<std::int32_t> order_;
    std::uint64_t state_ = 1;
};

}  // namespace softtissue
