// SPDX-License-Identifier: MIT
/// @file
/// From a count to a 32-bit index, refused where it does not fit.
///
/// What        the number as std::int32_t, in which meshes, patterns and factors store vertices, cells and entries.
///             Whoever numbers up to a count checks that count once, before the memory is asked for.
/// Refuses     numbers below 0 or above 2,147,483,647 (InvalidInput names what was counted).
/// Tests       tests/unit/core/checked_index_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <limits>

namespace softtissue {

inline constexpr Index largest_index = std::numeric_limits<std::int32_t>::max();

/// `what` are the parts of a text: "surface: vertices" gives "surface: vertices = 3000000000, expected ...".
template <class... What>
std::int32_t checked_index(Index count, const What&... what) {
    require(count >= 0 && count <= largest_index, what..., " = ", count, ", expected 0 to ", largest_index,
            " (indices are 32-bit)");
    return static_cast<std::int32_t>(count);
}

}  // namespace softtissue
