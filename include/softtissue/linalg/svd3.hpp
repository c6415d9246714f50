// SPDX-License-Identifier: MIT
/// @file
/// Singular value decomposition of a 3x3 matrix with proper rotations on both sides.
///
/// What        F = U diag(sigma) V^T, det U = det V = +1, sigma_0 >= sigma_1 >= |sigma_2|,
///             the sign of sigma_2 is the sign of det F
/// Shapes      F, U, V: 3x3.  sigma: 3.
/// Valid       every finite F: zero, repeated and subnormal singular values included.  Where F is not finite, all is NaN.
/// Accuracy    U, V orthonormal and F reproduced to a few epsilon |F|; small singular values of column-scaled
///             matrices keep their relative accuracy, as one-sided Jacobi does
/// Source      one-sided Jacobi: Hestenes 1958; sign convention: Irving, Teran, Fedkiw 2004, sec. 4
/// Cost        4 to 6 sweeps of 3 plane rotations
/// Tests       tests/unit/linalg/svd3_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

/// F = U diag(sigma) V^T with proper rotations U, V.
template <RealScalar Scalar>
struct Svd3 {
    Matrix3<Scalar> U;
    Vector3<Scalar> sigma;
    Matrix3<Scalar> V;
};

namespace detail {

/// The cross product, without the weight of Eigen/Geometry.
template <class Scalar>
Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
    return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
}

/// A unit vector orthogonal to the unit vector `u`.
template <class Scalar>
Vector3<Scalar> any_orthogonal(const Vector3<Scalar>& u) {
    Index smallest = 0;
    u.cwiseAbs().minCoeff(&smallest);
    const Vector3<Scalar> axis = Vector3<Scalar>::Unit(smallest);
    return cross(u, axis).normalized();
}

/// Rotates columns p and q of B (and of V alike) until they are orthogonal; false if they already were.
template <class Scalar>
bool orthogonalise_columns(Matrix3<Scalar>& B, Matrix3<Scalar>& V, int p, int q) {
    const Scalar alpha = B.col(p).squaredNorm();
    const Scalar beta = B.col(q).squaredNorm();
    const Scalar gamma = B.col(p).dot(B.col(q));
    // Rounding alone leaves a cosine of up to 1.5 epsilon.
    constexpr Scalar tolerance = Scalar(2) * std::numeric_limits<Scalar>::epsilon();
    if (std::abs(gamma) <= tolerance * std::sqrt(alpha) * std::sqrt(beta)) {
        return false;
    }
    const Scalar zeta = (beta - alpha) / (Scalar(2) * gamma);
    const Scalar t = std::copysign(Scalar(1), zeta) / (std::abs(zeta) + std::sqrt(Scalar(1) + zeta * zeta));
    const Scalar c = Scalar(1) / std::sqrt(Scalar(1) + t * t);
    const Scalar s = c * t;
    for (Matrix3<Scalar>* M : {&B, &V}) {
        const Vector3<Scalar> m = M->col(p);
        M->col(p) = c * m - s * M->col(q);
        M->col(q) = s * m + c * M->col(q);
    }
    return true;
}

/// Orders columns p and q by length, keeping the handedness of V.
template <class Scalar>
void sort_columns(Matrix3<Scalar>& B, Matrix3<Scalar>& V, int p, int q) {
    if (B.col(p).squaredNorm() < B.col(q).squaredNorm()) {
        for (Matrix3<Scalar>* M : {&B, &V}) {
            const Vector3<Scalar> m = M->col(p);
            M->col(p) = M->col(q);
            M->col(q) = -m;
        }
    }
}

}  // namespace detail

/// The singular value decomposition of F with proper rotations; see the file comment.
template <RealScalar Scalar>
Svd3<Scalar> svd3(const Matrix3<Scalar>& F) {
    const Scalar scale = F.cwiseAbs().maxCoeff();
    if (!F.allFinite()) {
        const Matrix3<Scalar> nan = Matrix3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
        return {nan, nan.col(0), nan};
    }
    if (scale == Scalar(0)) {
        return {Matrix3<Scalar>::Identity(), Vector3<Scalar>::Zero(), Matrix3<Scalar>::Identity()};
    }
    Matrix3<Scalar> B = F / scale;
    Matrix3<Scalar> V = Matrix3<Scalar>::Identity();
    constexpr int max_sweeps = 12;  // convergence is quadratic; 4 to 6 are met
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        bool rotated = detail::orthogonalise_columns(B, V, 0, 1);
        rotated = detail::orthogonalise_columns(B, V, 0, 2) || rotated;
        rotated = detail::orthogonalise_columns(B, V, 1, 2) || rotated;
        if (!rotated) {
            break;
        }
    }
    detail::sort_columns(B, V, 0, 1);
    detail::sort_columns(B, V, 0, 2);
    detail::sort_columns(B, V, 1, 2);

    // B = U diag(sigma): the first two columns of U are those of B normalised, the third completes the
    // right-handed frame, which gives sigma_2 its sign.
    const Vector3<Scalar> u0 = B.col(0).normalized();
    const Vector3<Scalar> b1 = B.col(1) - u0 * u0.dot(B.col(1));
    const bool is_rank_one = b1.squaredNorm() < std::numeric_limits<Scalar>::min();
    const Vector3<Scalar> u1 = is_rank_one ? detail::any_orthogonal(u0) : Vector3<Scalar>(b1.normalized());
    Svd3<Scalar> result;
    result.U.col(0) = u0;
    result.U.col(1) = u1;
    result.U.col(2) = detail::cross(u0, u1);
    result.sigma.setZero();
    result.sigma(0) = B.col(0).norm();
    if (!is_rank_one) {  // rounding must not break the order of equal values
        result.sigma(1) = std::min(b1.norm(), result.sigma(0));
        result.sigma(2) = std::clamp(result.U.col(2).dot(B.col(2)), -result.sigma(1), result.sigma(1));
    }
    result.sigma *= scale;
    result.V = V;
    return result;
}

}  // namespace softtissue
