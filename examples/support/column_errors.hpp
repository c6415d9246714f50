// SPDX-License-Identifier: MIT
/// @file
/// How far the columns of a layered body are from where a reference has them.
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/ndg/evaluation.hpp>

namespace examples {

/// Per column, the mean of its vertices on the muscle wrap and on the skin [m].
inline softtissue::VectorX<double> column_errors(const softtissue::LayeredBody<double>& body,
                                                 const softtissue::Matrix3X<double>& x,
                                                 const softtissue::Matrix3X<double>& reference) {
    const softtissue::VectorX<double> errors = softtissue::vertex_errors(x, reference);
    softtissue::VectorX<double> result(body.num_columns());
    for (softtissue::Index c = 0; c < body.num_columns(); ++c) {
        result(c) = 0.5 * (errors(body.layers.vertex(c, 1)) + errors(body.layers.vertex(c, 2)));
    }
    return result;
}

}  // namespace examples
