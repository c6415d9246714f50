// SPDX-License-Identifier: MIT
/// @file
/// What a glTF file says of a surface in a way that cannot be taken as it is, and was mended.
///
/// What        counts and sizes, all zero for a file in order; the programs print what is not
/// Tests       tests/unit/io/gltf_repairs_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <algorithm>

namespace softtissue {

struct GltfRepairs {
    Index rescaled_vertices = 0;     ///< whose weights do not sum to one, rounding apart: divided by their sum
    double largest_sum_error = 0.0;  ///< |sum - 1| of these
    Index averaged_places = 0;       ///< where vertices of different weights lie: the mean of them
    double largest_weight_difference = 0.0;
    Index lost_triangles = 0;  ///< had two corners at one place: left out

    void count_rescaled(double sum_error) {
        ++rescaled_vertices;
        largest_sum_error = std::max(largest_sum_error, sum_error);
    }

    void count_averaged(double difference) {
        ++averaged_places;
        largest_weight_difference = std::max(largest_weight_difference, difference);
    }
};

}  // namespace softtissue
