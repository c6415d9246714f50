// SPDX-License-Identifier: MIT
/// @file
/// The numbers that a network's weights are kept in for inference.
///
/// What        WeightFormat and its names
/// Formats     full      the weights as they were trained, 4 or 8 bytes each
///             bfloat16  2 bytes each, 8 significant bits
///             int8      in the last layer 1 byte each, a step size a row; other layers bfloat16
///             int4      in the last layer half a byte each, but one byte along the directions in which its input varies
///                       most; other layers bfloat16, those between the first and the last hidden one int8
/// Tests       tests/unit/nn/weight_format_test.cpp
#pragma once

#include <array>

namespace softtissue {

enum class WeightFormat { full, bfloat16, int8, int4 };

inline constexpr std::array all_weight_formats{WeightFormat::full, WeightFormat::bfloat16, WeightFormat::int8,
                                               WeightFormat::int4};

/// The format's name, as in the enumeration.
constexpr const char* to_string(WeightFormat format) {
    switch (format) {
        case WeightFormat::full:
            return "full";
        case WeightFormat::bfloat16:
            return "bfloat16";
        case WeightFormat::int8:
            return "int8";
        case WeightFormat::int4:
            return "int4";
    }
    return "unknown";
}

}  // namespace softtissue
