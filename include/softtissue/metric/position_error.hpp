// SPDX-License-Identifier: MIT
/// @file
/// How far vertices are from where they should be.
///
/// What        mean and largest distance over the vertices that are not prescribed.
/// Equation    E_pos = 1/N_v sum_v |x_v - x^_v|
/// Shapes      x, reference 3 x vertices [m]; results in m (the paper's tables are in mm).
/// Valid       no free vertices give 0. A position that is not finite gives NaN or infinity.
/// Refuses     arrays of different sizes (InvalidInput)
/// Source      Nolte et al. 2026, eq. (18)
/// Tests       tests/unit/metric/position_error_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>

#include <cstdint>

namespace softtissue {

template <RealScalar S>
struct PositionError {
    S mean = S(0);                   ///< E_pos [m]
    S largest = S(0);                ///< [m]
    std::int32_t worst_vertex = -1;  ///< -1 if all are exact
};

template <RealScalar S>
PositionError<S> position_error(const Matrix3X<S>& x, const Matrix3X<S>& reference,
                                const PrescribedVertices& prescribed) {
    require(x.cols() == prescribed.num_vertices() && reference.cols() == x.cols(), "position error: ", x.cols(),
            " positions, ", reference.cols(), " reference positions, ", prescribed.num_vertices(),
            " vertices, expected equal numbers");
    PositionError<S> error;
    double sum = 0;
    for (const std::int32_t v : prescribed.free_vertices()) {
        const S distance = (x.col(v) - reference.col(v)).norm();
        sum += static_cast<double>(distance);
        if (distance > error.largest) {
            error.largest = distance;
            error.worst_vertex = v;
        }
    }
    if (prescribed.num_free() > 0) {
        error.mean = static_cast<S>(sum / static_cast<double>(prescribed.num_free()));
    }
    return error;
}

}  // namespace softtissue
