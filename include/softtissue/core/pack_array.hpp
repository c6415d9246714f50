// SPDX-License-Identifier: MIT
/// @file
/// Some numbers of each of many items, laid out for loops over packs of items.
///
/// What        item i is lane i % width of pack i / width; the lanes beyond the last item repeat it
/// Layout      a pack's numbers lie together, each `width` times: one contiguous read a pack
/// Shapes      `count` numbers an item. Numbers that cannot stand in packs (Dual) stand alone, width 1.
/// Tests       tests/unit/core/pack_array_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cstddef>

namespace softtissue {

namespace detail {

template <class S>
struct NaturalPack {
    static constexpr int width = 1;
    using Lanes = S;
};

template <RealScalar S>
struct NaturalPack<S> {
    static constexpr int width = natural_lanes<S>;
    using Lanes = Pack<S, width>;
};

}  // namespace detail

template <FieldScalar S, int count>
class PackArray {
public:
    using Scalar = S;
    using Lanes = typename detail::NaturalPack<S>::Lanes;
    static constexpr int width = detail::NaturalPack<S>::width;

    PackArray() = default;
    /// Uninitialised.
    explicit PackArray(Index num_items) : num_items_(num_items), packs_(count, (num_items + width - 1) / width) {}

    Index num_items() const { return num_items_; }
    Index num_packs() const { return packs_.cols(); }

    /// The item in a lane of a pack.
    Index item(Index pack, int lane) const { return std::min(width * pack + lane, num_items_ - 1); }

    /// Number k of an item.
    Scalar at(Index item, int k) const {
        SOFTTISSUE_ASSERT(item >= 0 && item < num_items_);
        if constexpr (RealScalar<S>) {
            return packs_(k, item / width)[int(item % width)];
        } else {
            return packs_(k, item);
        }
    }
    void set(Index item, int k, const Scalar& number) {
        SOFTTISSUE_ASSERT(item >= 0 && item < num_items_);
        if constexpr (RealScalar<S>) {
            const Index last = item == num_items_ - 1 ? width - 1 : item % width;
            for (Index lane = item % width; lane <= last; ++lane) {
                packs_(k, item / width).lanes[std::size_t(lane)] = number;
            }
        } else {
            packs_(k, item) = number;
        }
    }

    /// Numbers first, first + 1, ... of an item, in the order of a matrix' memory.
    template <class Matrix>
    Matrix matrix_at(Index item, int first = 0) const {
        Matrix result;
        for (int k = 0; k < int(Matrix::SizeAtCompileTime); ++k) {
            result.data()[k] = at(item, first + k);
        }
        return result;
    }
    template <int rows, int columns>
    void set(Index item, int first, const Eigen::Matrix<Scalar, rows, columns>& numbers) {
        for (int k = 0; k < rows * columns; ++k) {
            set(item, first + k, numbers.data()[k]);
        }
    }

    /// The same of a pack of items.
    const Lanes& pack_at(Index pack, int k) const { return packs_(k, pack); }
    template <int rows, int columns>
    Eigen::Map<const Eigen::Matrix<Lanes, rows, columns>> packed_matrix_at(Index pack, int first = 0) const {
        return Eigen::Map<const Eigen::Matrix<Lanes, rows, columns>>(&packs_(first, pack));
    }

private:
    Index num_items_ = 0;
    Eigen::Matrix<Lanes, count, Eigen::Dynamic> packs_;
};

}  // namespace softtissue
