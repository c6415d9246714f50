// SPDX-License-Identifier: MIT
/// @file
/// Weights of two bytes: floats without the lower half of their mantissa.
///
/// What        BFloat16Weights, a WeightPacking (nn/concepts.hpp)
/// Equation    w rounded to nearest with 8 significant bits, ties to even: |error| <= |w| / 256, or 2^-134 below the normal
///             numbers. Products with floats, sums in float: each within (n / 2 + 2) epsilon times the sum of |w x|.
/// Layout      a word holds two inputs of one row, the first in its lower half
/// Refuses     nothing: a weight that rounds to infinity is refused by PackedRows
/// Tests       tests/unit/nn/bfloat16_weights_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/word_pack.hpp>
#include <softtissue/nn/float_columns.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace softtissue {

struct BFloat16Weights {
    using Columns = FloatColumns;
    using Floats = WordPack::Floats;
    static constexpr bool has_steps = false;
    static constexpr Index block_inputs = 2, block_elements = 2;

    static constexpr int shift(Index input) { return 16 * static_cast<int>(input); }

    static bool can_store(float weight) { return std::isfinite(value(code(weight, 1.0F), 1.0F)); }
    static float step(const float*, Index) { return 1.0F; }
    static std::uint32_t code(float weight, float) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(weight);
        return (bits + 0x7fffU + (bits >> 16 & 1U)) >> 16;
    }
    static double value(std::uint32_t code, float) { return double(std::bit_cast<float>(code << 16)); }

    /// The weights of one word of every row, in float.
    struct Block {
        Floats first, second;
        [[gnu::always_inline]] explicit Block(const WordPack& words)
            : first(words.shifted_left(16).as_floats()), second(words.masked(0xffff0000U).as_floats()) {}
    };

    /// Products summed so far, those of the lower and of the upper halves of the words.
    struct Sums {
        Floats first = 0.0F, second = 0.0F;

        [[gnu::always_inline]] void add(const Block& weights, const float* x) {
            first += weights.first * Floats(x[0]);
            second += weights.second * Floats(x[1]);
        }
        Floats total(const FloatColumns&, Index) const { return first + second; }
    };
};

}  // namespace softtissue
