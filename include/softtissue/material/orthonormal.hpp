// SPDX-License-Identifier: MIT
/// @file
/// Refuses a 3x3 basis whose columns are not orthonormal.
///
/// What        require_orthonormal(B, name...); either handedness is accepted
/// Refuses     |B^T B - I| > 1e-5 in any entry, NaN (InvalidInput): loose enough for a basis that was stored in float
/// Tests       tests/unit/material/orthonormal_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>

namespace softtissue {

/// Refuses B unless B^T B = I to 1e-5; the parts of its name are streamed into the message.
template <FieldScalar Scalar, class... Name>
void require_orthonormal(const Matrix3<Scalar>& B, const Name&... name) {
    using Real = RealOf<Scalar>;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            const Real product = value_of(B.col(i).dot(B.col(j)));
            const Real expected = i == j ? Real(1) : Real(0);
            using std::abs;
            require(abs(product - expected) <= Real(1e-5), name..., ": column ", i, " times column ", j, " = ", product,
                    ", expected ", expected, " (orthonormal)");
        }
    }
}

}  // namespace softtissue
