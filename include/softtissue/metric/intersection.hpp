// SPDX-License-Identifier: MIT
/// @file
/// Whether an inner surface crosses the skin.
///
/// What        the number of crossing pairs of a skin and an inner triangle; a frame with intersection has at least one.
/// Shapes      positions 3 x n [m], triangles 3 x m.
/// Valid       Crossings count wherever they are, also where skin folds at a joint lie inside the body: protrusion.hpp tells
///             whether something sticks out. Touching triangles do not count.
/// Source      Nolte et al. 2026, sec. 5.3, "frames with intersection"
/// Tests       tests/unit/metric/intersection_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/crossing_triangles.hpp>

namespace softtissue {

struct Intersection {
    Index num_pairs = 0;

    bool is_present() const { return num_pairs > 0; }
};

template <RealScalar S>
Intersection compute_intersection(const Matrix3X<S>& skin, const Triangles& skin_triangles, const Matrix3X<S>& inner,
                                  const Triangles& inner_triangles) {
    return {static_cast<Index>(crossing_triangles(skin, skin_triangles, inner, inner_triangles).size())};
}

}  // namespace softtissue
