// SPDX-License-Identifier: MIT
/// @file
/// x -> A x + t.
///
/// What        one affine map of space, the transform of a joint or of a skinned vertex.
/// Shapes      linear 3x3 [-], translation 3 [m].
/// Tests       tests/unit/skinning/affine_transform_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

namespace softtissue {

/// d det(A) / dA: the transposed adjugate; A^-1 = cofactors(A)^T / det(A), defined for singular A too.
template <FieldScalar S>
Matrix3<S> cofactors(const Matrix3<S>& A) {
    Matrix3<S> result;
    for (int row = 0; row < 3; ++row) {
        for (int col = 0; col < 3; ++col) {
            const int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (col + 1) % 3, c2 = (col + 2) % 3;
            result(row, col) = A(r1, c1) * A(r2, c2) - A(r1, c2) * A(r2, c1);
        }
    }
    return result;
}

template <FieldScalar S>
struct AffineTransform {
    using Scalar = S;

    Matrix3<Scalar> linear = Matrix3<Scalar>::Identity();
    Vector3<Scalar> translation = Vector3<Scalar>::Zero();

    /// A x + t.
    Vector3<Scalar> operator()(const Vector3<Scalar>& x) const { return linear * x + translation; }

    /// The map that applies `inner` first.
    AffineTransform operator*(const AffineTransform& inner) const {
        return {linear * inner.linear, linear * inner.translation + translation};
    }

    /// x -> A^-1 (x - t). Not finite where A is singular; skinning/inverse.hpp measures how near that is.
    AffineTransform inverse() const {
        const Matrix3<Scalar> C = cofactors(linear);
        const Scalar det = C.col(0).dot(linear.col(0));
        const Matrix3<Scalar> inverse_linear = C.transpose() / det;
        return {inverse_linear, -(inverse_linear * translation)};
    }
};

}  // namespace softtissue
