// SPDX-License-Identifier: MIT
/// @file
/// Weights of half a byte: whole multiples of a step that each row has for itself.
///
/// What        Int4Weights, a WeightPacking (nn/concepts.hpp)
/// Equation    w = step k + r, k in -8 .. 7, |r| <= |step| / 2;  |step| as small as the row's largest and smallest weight
///             allow, its sign such that the longer side has 8 steps
/// Sums        of the products with DigitColumns exact, in whole numbers; then two roundings to float and three products
/// Layout      a word holds k + 8 of eight inputs of one row: inputs 0 to 3 in the lower halves of its bytes, the lowest
///             byte first, inputs 4 to 7 in the upper halves
/// Valid       a row of zeros has the step 0
/// Tests       tests/unit/nn/int4_weights_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/word_pack.hpp>
#include <softtissue/nn/digit_columns.hpp>
#include <softtissue/nn/int8_weights.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace softtissue {

struct Int4Weights {
    using Columns = DigitColumns;
    static constexpr bool has_steps = true;
    static constexpr Index block_inputs = 8, block_elements = 4;

    static constexpr int shift(Index input) { return 8 * static_cast<int>(input % 4) + (input < 4 ? 0 : 4); }

    static bool can_store(float weight) { return std::isfinite(weight); }
    static float step(const float* weights, Index count) {
        float up = 0.0F, down = 0.0F;
        for (Index i = 0; i < count; ++i) {
            up = std::max(up, weights[i]);
            down = std::max(down, -weights[i]);
        }
        const auto covering = [](float eight, float seven) {
            return std::max(detail::step_that_covers(eight, 8), detail::step_that_covers(seven, 7));
        };
        const float positive = covering(down, up), negative = covering(up, down);
        return positive <= negative ? positive : -negative;
    }
    static std::uint32_t code(float weight, float step) {
        return static_cast<std::uint32_t>(detail::nearest_multiple(weight, step) + 8);
    }
    static double value(std::uint32_t code, float step) { return (double(code & 15U) - 8) * double(step); }

    /// The weights of one word of every row: the lower and the upper digits of its bytes.
    struct Block {
        WordPack lower, upper;
        [[gnu::always_inline]] explicit Block(const WordPack& words)
            : lower(words.masked(0x0f0f0f0fU)), upper(words.shifted_right(4).masked(0x0f0f0f0fU)) {}
    };

    /// Products summed so far, in integers.
    struct Sums : detail::DigitSums<8> {
        [[gnu::always_inline]] void add(const Block& weights, const std::int32_t* digits) {
            DigitSums::add(weights.lower, digits);
            DigitSums::add(weights.upper, digits + 2);
        }
    };
};

}  // namespace softtissue
