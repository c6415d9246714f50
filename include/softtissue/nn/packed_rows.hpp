// SPDX-License-Identifier: MIT
/// @file
/// A wide matrix of weights in few bytes, for products with one or a few columns.
///
/// What        PackedRows: rows that a WeightPacking rounds and packs; y += W x
/// Layout      64 rows a tile. Tiles lie one after the other, each one piece of memory: of the first few inputs a word for
///             each row, of the next few, and so on. Lanes are rows, so no sum is ever taken across lanes, and a product is
///             one long way through memory, on which what comes next is asked for in time.
/// Shapes      W: rows x inputs; x: inputs x batch, prepared as W's Columns; y: rows x batch, columns a stride apart
/// Order       entry (r, s) of the product has the same bits whatever the other rows and samples are
/// Refuses     no rows, no inputs, more than 65,536 inputs, weights that are not finite as W stores them (InvalidInput names
///             row and input)
/// Cost        every weight is read once for up to four samples. The product allocates nothing.
/// Tests       tests/unit/nn/packed_rows_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/prefetch.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/core/word_pack.hpp>
#include <softtissue/nn/concepts.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace softtissue {

/// Refuses a weight of a layer.
template <RealScalar S>
void require_storable(bool is_storable, const std::string& name, Index row, Index input, S weight) {
    require(is_storable, name, ": weight (", row, ", ", input, ") is ", weight, ", expected a finite number");
}

template <WeightPacking W>
class PackedRows {
public:
    using Columns = typename W::Columns;
    static constexpr Index tile_rows = 64;

    PackedRows(Index rows, Index inputs) : rows_(rows), inputs_(inputs) {
        require(rows >= 1 && inputs >= 1 && inputs <= 65536, "packed weights: ", rows, " rows of ", inputs,
                " inputs, expected at least one of each and at most 65536 inputs");
        const Index tiles = (rows + tile_rows - 1) / tile_rows;
        blocks_ = (inputs + W::block_inputs - 1) / W::block_inputs;
        words_ = VectorX<std::uint32_t>::Zero(tile_rows * blocks_ * tiles + words_ahead);
        steps_ = VectorX<float>::Zero(W::has_steps ? tile_rows * tiles : 0);
    }

    Index rows() const { return rows_; }
    Index inputs() const { return inputs_; }
    std::size_t num_bytes() const { return size_t(4 * (words_.size() + steps_.size())); }

    /// Rounds and stores one row; `name` is what a refused weight is said to belong to.
    template <RealScalar S>
    void set_row(Index row, const S* weights, const std::string& name) {
        VectorX<float> numbers(inputs_);
        for (Index k = 0; k < inputs_; ++k) {
            numbers(k) = float(weights[k]);
            require_storable(W::can_store(numbers(k)), name, row, k, weights[k]);
        }
        const float row_step = W::step(numbers.data(), inputs_);
        if constexpr (W::has_steps) {
            steps_(row) = row_step;
        }
        for (Index block = 0; block < blocks_; ++block) {
            std::uint32_t word = 0;
            for (Index j = 0; j < W::block_inputs; ++j) {
                const Index k = W::block_inputs * block + j;
                word |= W::code(k < inputs_ ? numbers(k) : 0.0F, row_step) << W::shift(j);
            }
            words_(first_word(row) + tile_rows * block) = word;
        }
    }

    /// The weight that is stored.
    double value(Index row, Index input) const {
        const std::uint32_t word = words_(first_word(row) + tile_rows * (input / W::block_inputs));
        const int bits = 32 / static_cast<int>(W::block_inputs);
        return W::value((word >> W::shift(input % W::block_inputs)) & ((1U << bits) - 1U), step(row));
    }

    /// Of whole multiples; 1 where there is none.
    float step(Index row) const { return W::has_steps ? steps_(row) : 1.0F; }

    /// y += W x of `count` rows from `first` on, a multiple of tile_rows; y points to the first of these rows.
    template <RealScalar S>
    void add_product(Index first, Index count, const Columns& x, S* y, Index y_stride) const {
        SOFTTISSUE_ASSERT(first % tile_rows == 0 && first + count <= rows_);
        const Index end = (first + count + lanes - 1) / lanes;
        Index strip = first / lanes;
        const Target<S> target{y - first, y_stride, first + count};
        for (; strip + 4 <= end; strip += 4) {
            add_strips<4>(strip, x, target);
        }
        for (; strip < end; ++strip) {
            add_strips<1>(strip, x, target);
        }
    }

private:
    static constexpr Index words_ahead = 2048;  ///< two pages of memory

    /// Of one register: a strip of a tile.
    static constexpr Index lanes = std::min<Index>(WordPack::lanes, tile_rows);

    template <class S>
    struct Target {
        S* y;
        Index stride, end;
    };

    template <int strips, class S>
    void add_strips(Index strip, const Columns& x, const Target<S>& target) const {
        Index sample = 0;
        for (; sample + 4 <= x.batch(); sample += 4) {
            constexpr int few = std::min(strips, 2);  // sums of more do not fit the registers
            for (int s = 0; s < strips; s += few) {
                add_tile<few, 4>(strip + s, x, sample, target);
            }
        }
        for (; sample + 2 <= x.batch(); sample += 2) {
            add_tile<strips, 2>(strip, x, sample, target);
        }
        for (; sample < x.batch(); ++sample) {
            add_tile<strips, 1>(strip, x, sample, target);
        }
    }

    template <int strips, int samples, class S>
    void add_tile(Index strip, const Columns& x, Index sample, const Target<S>& target) const {
        add_tile(strip, x, sample, target, std::make_index_sequence<size_t(strips)>(),
                 std::make_index_sequence<size_t(samples)>());
    }

    /// Written out: in a loop over strips and samples compilers keep the sums in memory.
    template <class S, std::size_t... s, std::size_t... c>
    void add_tile(Index strip, const Columns& x, Index sample, const Target<S>& target, std::index_sequence<s...>,
                  std::index_sequence<c...>) const {
        const std::array words{(words_.data() + first_word((strip + Index(s)) * lanes))...};
        const std::array columns{x.column(sample + Index(c))...};
        std::array<std::array<typename W::Sums, sizeof...(c)>, sizeof...(s)> sums;
        for (Index block = 0; block < blocks_; ++block) {
            (add_block(sums[s], words[s] + tile_rows * block, columns, W::block_elements * block,
                       std::index_sequence<c...>()),
             ...);
        }
        const auto add_sums = [&](std::size_t k) {
            (add_to(target, (strip + Index(k)) * lanes, sample + Index(c), sums[k][c].total(x, sample + Index(c))),
             ...);
        };
        (add_sums(s), ...);
    }

    template <class Sums, class Columns_, std::size_t... c>
    [[gnu::always_inline]] static inline void add_block(Sums& sums, const std::uint32_t* words, const Columns_& columns,
                                                        Index element, std::index_sequence<c...>) {
        prefetch(words + words_ahead);
        const typename W::Block weights(WordPack::load(words));
        (sums[c].add(weights, columns[c] + element), ...);
    }

    /// Of a row, or of the strip that begins with it.
    Index first_word(Index row) const { return row / tile_rows * (tile_rows * blocks_) + row % tile_rows; }

    template <class S>
    void add_to(const Target<S>& target, Index row, Index sample, WordPack::Floats total) const {
        if constexpr (W::has_steps) {
            total *= WordPack::Floats::load(steps_.data() + row);
        }
        float numbers[lanes];
        total.store(numbers);
        S* const y = target.y + target.stride * sample + row;
        if (row + lanes <= target.end) {
            for (int l = 0; l < lanes; ++l) {
                y[l] += S(numbers[l]);
            }
        } else {
            for (int l = 0; l < target.end - row; ++l) {
                y[l] += S(numbers[l]);
            }
        }
    }

    Index rows_, inputs_, blocks_ = 0;
    VectorX<std::uint32_t> words_;  ///< and two pages that are asked for but not used
    VectorX<float> steps_;
};

}  // namespace softtissue
