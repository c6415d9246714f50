// SPDX-License-Identifier: MIT
/// @file
/// How far inner anatomy sticks out of the skin.
///
/// What        the inner vertices outside the skin, and their distances to it.
/// Equation    outside: winding number of the skin < 1/2; magnitude: the largest distance of those to the skin
/// Shapes      skin and inner positions 3 x n [m]; distances in m (the paper's table is in mm).
/// Valid       a skin that faces outwards; holes are bridged by the winding number. Vertices on the skin, within rounding of it,
///             do not protrude. Which vertices count (the paper leaves out head, hands and toes) is up to the caller.
/// Refuses     inner positions that are not finite, a skin without triangles, and what WindingNumber refuses (InvalidInput)
/// Source      Nolte et al. 2026, sec. 5.3, "frames with protrusion" and "protrusion magnitude"
/// Departs     the paper does not say how the distances of a frame become one magnitude: the largest and the mean are given.
/// Tests       tests/unit/metric/protrusion_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/closest_point_on_triangle.hpp>
#include <softtissue/mesh/triangle_boxes.hpp>
#include <softtissue/mesh/winding_number.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct Protrusion {
    Index num_vertices = 0;          ///< inner vertices outside the skin
    S magnitude = S(0);              ///< the largest distance of those to the skin [m]
    S mean = S(0);                   ///< their mean distance [m]
    std::int32_t worst_vertex = -1;  ///< -1 if none is outside

    bool is_present() const { return num_vertices > 0; }
};

template <RealScalar S, Executor Exec = SequentialExecutor>
Protrusion<S> compute_protrusion(const Matrix3X<S>& skin, const Triangles& skin_triangles, const Matrix3X<S>& inner,
                                 const Exec& executor = {}) {
    for (Index v = 0; v < inner.cols(); ++v) {
        require(inner.col(v).allFinite(), "protrusion: inner vertex ", v, " is not finite");
    }
    require(skin_triangles.cols() > 0, "protrusion: the skin has no triangles");
    const WindingNumber<S> winding(skin, skin_triangles);
    VectorX<S> distances = VectorX<S>::Zero(inner.cols());  // 0 inside
    executor.for_each_range(inner.cols(), [&](Index begin, Index end) {
        for (Index v = begin; v < end; ++v) {
            const Vector3<S> p = inner.col(v);
            if (winding(p) < S(0.5)) {
                const auto squared_distance = [&](std::int32_t t) {
                    return closest_point_on_triangle<S>(triangle_corners(skin, skin_triangles, t), p).squared_distance;
                };
                distances(v) = std::sqrt(winding.tree().nearest(p, squared_distance).squared_distance);
            }
        }
    });
    const S rounding = S(16) * std::numeric_limits<S>::epsilon() * skin.cwiseAbs().maxCoeff();
    Protrusion<S> result;
    double sum = 0;
    for (Index v = 0; v < inner.cols(); ++v) {
        if (distances(v) > rounding) {
            ++result.num_vertices;
            sum += static_cast<double>(distances(v));
            if (distances(v) > result.magnitude) {
                result.magnitude = distances(v);
                result.worst_vertex = static_cast<std::int32_t>(v);
            }
        }
    }
    if (result.is_present()) {
        result.mean = static_cast<S>(sum / static_cast<double>(result.num_vertices));
    }
    return result;
}

}  // namespace softtissue
