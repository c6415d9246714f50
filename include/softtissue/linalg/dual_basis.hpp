// SPDX-License-Identifier: MIT
/// @file
/// The dual of three vectors: B^-T by cross products.
///
/// What        columns b^k with b^i . B_j = delta_ij for the columns B_j of B, i.e. the inverse transpose. A symmetric
///             B gives its inverse.
/// Shapes      B, result 3x3.
/// Valid       det B != 0; a singular B gives infinities or NaN, never a throw (the caller validates cells).
/// Cost        40 flop, branch-free, any FieldScalar.
/// Tests       tests/unit/linalg/dual_basis_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <Eigen/Geometry>

namespace softtissue {

/// B^-T.
template <class Scalar>
Matrix3<Scalar> dual_basis(const Matrix3<Scalar>& B) {
    Matrix3<Scalar> dual;
    dual.col(0) = B.col(1).cross(B.col(2));
    dual.col(1) = B.col(2).cross(B.col(0));
    dual.col(2) = B.col(0).cross(B.col(1));
    const Scalar determinant = B.col(0).dot(dual.col(0));
    return dual / determinant;
}

}  // namespace softtissue
