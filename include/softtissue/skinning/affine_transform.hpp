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
#include <softtissue/linalg/cofactor.hpp>

namespace softtissue {

template <FieldScalar S>
struct AffineTransform {
    using Scalar = S;

    Matrix3<Scalar> linear = Matrix3<Scalar>::Identity();
    Vector3<Scalar> translation = Vector3<Scalar>::Zero();

    /// A x + t.
    Vector3<Scalar> operator()(const Vector3<Scalar>& x) const { return linear * x + translation; }

    /// Every entry.
    bool is_finite() const {
        Scalar zero(0);
        for (int k = 0; k < 9; ++k) {
            zero += linear.data()[k] * Scalar(0);
        }
        for (int k = 0; k < 3; ++k) {
            zero += translation(k) * Scalar(0);
        }
        return value_of(zero) == RealOf<Scalar>(0);
    }

    /// The map that applies `inner` first.
    AffineTransform operator*(const AffineTransform& inner) const {
        return {linear * inner.linear, linear * inner.translation + translation};
    }

    /// x -> A^-1 (x - t). Not finite where A is singular; skinning/inverse.hpp measures how near that is.
    AffineTransform inverse() const {
        const Matrix3<Scalar> cof = cofactor(linear);
        const Matrix3<Scalar> inverse_linear = cof.transpose() / determinant(linear, cof);
        return {inverse_linear, -(inverse_linear * translation)};
    }
};

}  // namespace softtissue
