// SPDX-License-Identifier: MIT
/// @file
/// Weights of one byte: whole multiples of a step that each row has for itself.
///
/// What        Int8Weights, a WeightPacking (nn/concepts.hpp)
/// Equation    w = step k + r, k in -127 .. 127, |r| <= step / 2;  step = max |w| / 127 of the row, rounded up
/// Sums        of the products with DigitColumns exact, in whole numbers; then two roundings to float and three products
/// Layout      a word holds k + 128 of four inputs of one row, the first in its lowest byte
/// Valid       a row of zeros has the step 0
/// Tests       tests/unit/nn/int8_weights_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/word_pack.hpp>
#include <softtissue/nn/digit_columns.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace softtissue {

namespace detail {

/// The smallest float that goes at least `count` times into `magnitude`, but 0 for 0.
inline float step_that_covers(float magnitude, int count) {
    const float step = magnitude / float(count);
    const bool is_short = double(step) * count < double(magnitude);
    return is_short ? std::nextafter(step, std::numeric_limits<float>::infinity()) : step;
}

inline int nearest_multiple(float weight, float step) {
    return step != 0.0F ? static_cast<int>(std::rint(double(weight) / double(step))) : 0;
}

/// Sums of products of codes that exceed their numbers by `zero` with the two digits of a column.
template <std::int32_t zero>
struct DigitSums {
    WordPack high = WordPack::all(0), low = WordPack::all(0);

    [[gnu::always_inline]] void add(const WordPack& codes, const std::int32_t* digits) {
        high.add_byte_products(codes, digits[0]);
        low.add_byte_products(codes, digits[1]);
    }

    /// In units of the row's step.
    WordPack::Floats total(const DigitColumns& columns, Index sample) const {
        using Floats = WordPack::Floats;
        const DigitColumns::Summary& x = columns.summary(sample);
        const Floats upper = (high - WordPack::all(zero * x.high_sum)).to_floats();
        const Floats lower = (low - WordPack::all(zero * x.low_sum)).to_floats();
        return (upper * Floats(256.0F) + lower) * Floats(x.step);
    }
};

}  // namespace detail

struct Int8Weights {
    using Columns = DigitColumns;
    static constexpr bool has_steps = true;
    static constexpr Index block_inputs = 4, block_elements = 2;

    static constexpr int shift(Index input) { return 8 * static_cast<int>(input); }

    static bool can_store(float weight) { return std::isfinite(weight); }
    static float step(const float* weights, Index count) {
        float magnitude = 0.0F;
        for (Index i = 0; i < count; ++i) {
            magnitude = std::max(magnitude, std::abs(weights[i]));
        }
        return detail::step_that_covers(magnitude, 127);
    }
    static std::uint32_t code(float weight, float step) {
        return static_cast<std::uint32_t>(detail::nearest_multiple(weight, step) + 128);
    }
    static double value(std::uint32_t code, float step) { return (double(code & 255U) - 128) * double(step); }

    using Block = WordPack;

    struct Sums : detail::DigitSums<128> {};
};

}  // namespace softtissue
