// SPDX-License-Identifier: MIT
/// @file
/// Singular value decomposition of a 3x3 matrix with proper rotations on both sides.
///
/// What        F = U diag(sigma) V^T, det U = det V = +1, sigma_0 >= sigma_1 >= |sigma_2|,
///             the sign of sigma_2 is the sign of det F
/// Shapes      F, U, V: 3x3.  sigma: 3.
/// Valid       every finite F: zero, repeated and subnormal singular values included.  Where F is not finite, all is NaN.
///             Packs: a converged lane stands still while others go on, so that it never depends on them.
/// Accuracy    U, V orthonormal and F reproduced to a few epsilon |F|; small singular values of column-scaled
///             matrices keep their relative accuracy, as one-sided Jacobi does, above 1e-9 (float), 1e-76 (double) of |F|
/// Source      one-sided Jacobi: Hestenes 1958; sign convention: Irving, Teran, Fedkiw 2004, sec. 4
/// Departs     starts from the eigenvectors of F^T F (eigen_deflation3.hpp), which the sweeps then only confirm or improve,
///             unless the columns of F differ more than 16 times in length
/// Cost        one eigen-decomposition, one or two sweeps of 3 plane rotations; 4 to 6 sweeps of columns of different lengths
/// Tests       tests/unit/linalg/svd3_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/eigen_deflation3.hpp>
#include <softtissue/linalg/jacobi_rotation.hpp>
#include <softtissue/linalg/unit_scale.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

/// F = U diag(sigma) V^T with proper rotations U, V.
template <RealLanes Scalar>
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

/// A unit vector orthogonal to the unit vector `u`: its part across the axis that lies farthest from it.
template <class Scalar>
Vector3<Scalar> any_orthogonal(const Vector3<Scalar>& u) {
    using std::abs;
    const Scalar x = abs(u(0)), y = abs(u(1)), z = abs(u(2));
    const auto is_x = (x <= y) & (x <= z);
    const auto is_y = y <= z;
    const Scalar zero(0), one(1);
    const Vector3<Scalar> axis(select(is_x, one, zero), select(is_x, zero, select(is_y, one, zero)),
                               select(is_x, zero, select(is_y, zero, one)));
    const Vector3<Scalar> across = axis - u * u.dot(axis);
    return across * reciprocal_sqrt(Scalar(across.dot(across)));
}

/// Whether two vectors are not orthogonal, from their products with themselves and with each other.
template <class Scalar>
auto are_oblique(const Scalar& alpha, const Scalar& beta, const Scalar& gamma) {
    // Rounding alone leaves a cosine of up to 1.5 epsilon.
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    const Scalar cosine = gamma * Scalar(RealOf<Scalar>(0.5) / Limits::epsilon());
    return (cosine * cosine > alpha * beta) & (gamma * gamma > Scalar(Limits::min()));
}

/// Turns the columns of B and of the identity V by the eigenvectors of B^T B, which leaves them orthogonal to rounding of
/// |B|; not where they are orthogonal, and not where the longest is so long that this would cost the shortest its digits.
template <class Scalar>
void turn_to_eigenvectors(Matrix3<Scalar>& B, Matrix3<Scalar>& V) {
    using std::max;
    using std::min;
    Matrix3<Scalar> C;
    for (int j = 0; j < 3; ++j) {
        for (int i = j; i < 3; ++i) {
            C(i, j) = B.col(i).dot(B.col(j));
        }
    }
    const auto is_oblique = are_oblique(C(0, 0), C(1, 1), C(1, 0)) | are_oblique(C(0, 0), C(2, 2), C(2, 0)) |
                            are_oblique(C(1, 1), C(2, 2), C(2, 1));
    const Scalar longest = max(max(C(0, 0), C(1, 1)), C(2, 2)), shortest = min(min(C(0, 0), C(1, 1)), C(2, 2));
    const auto turns = is_oblique & (longest < RealOf<Scalar>(256) * shortest);
    if (!any_of(turns)) {
        return;
    }
    diagonalise_by_deflation(C);
    for (int k = 0; k < 9; ++k) {
        V.data()[k] = select(turns, C.data()[k], V.data()[k]);
    }
    const Matrix3<Scalar> old = B;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            B(i, j) = old(i, 0) * V(0, j) + old(i, 1) * V(1, j) + old(i, 2) * V(2, j);
        }
    }
}

/// Rotates columns p and q of B (and of V alike) until they are orthogonal; whether they were not.
template <class Scalar>
auto orthogonalise_columns(Matrix3<Scalar>& B, Matrix3<Scalar>& V, int p, int q) {
    const Scalar alpha = B.col(p).dot(B.col(p));
    const Scalar beta = B.col(q).dot(B.col(q));
    const Scalar gamma = B.col(p).dot(B.col(q));
    const auto is_oblique = are_oblique(alpha, beta, gamma);
    if (!any_of(is_oblique)) {
        return is_oblique;
    }
    const JacobiRotation<Scalar> rotation(Scalar(beta - alpha), Scalar(gamma + gamma));
    const Scalar cosine_or_1 = select(is_oblique, rotation.cosine, Scalar(1));
    const Scalar sine_or_0 = select(is_oblique, rotation.sine, Scalar(0));
    for (Matrix3<Scalar>* M : {&B, &V}) {
        for (int i = 0; i < 3; ++i) {
            const Scalar m = (*M)(i, p);
            (*M)(i, p) = cosine_or_1 * m - sine_or_0 * (*M)(i, q);
            (*M)(i, q) = sine_or_0 * m + cosine_or_1 * (*M)(i, q);
        }
    }
    return is_oblique;
}

/// Orders columns p and q by length, keeping the handedness of V.
template <class Scalar>
void sort_columns(Matrix3<Scalar>& B, Matrix3<Scalar>& V, int p, int q) {
    const auto is_shorter = B.col(p).dot(B.col(p)) < B.col(q).dot(B.col(q));
    if (!any_of(is_shorter)) {
        return;
    }
    for (Matrix3<Scalar>* M : {&B, &V}) {
        for (int i = 0; i < 3; ++i) {
            const Scalar m = (*M)(i, p);
            (*M)(i, p) = select(is_shorter, (*M)(i, q), m);
            (*M)(i, q) = select(is_shorter, Scalar(-m), (*M)(i, q));
        }
    }
}

/// U and sigma of a matrix B = U diag(sigma) with orthogonal columns, the longest first: the first two columns of U are
/// those of B normalised, the third completes the right-handed frame, which gives sigma_2 its sign.
template <class Scalar>
void split_lengths(const Matrix3<Scalar>& B, Svd3<Scalar>& result) {
    using std::max;
    using std::min;
    const Scalar zero(0), one(1);
    const Scalar squared_length = B.col(0).dot(B.col(0));
    const auto is_zero = squared_length == zero;
    const Scalar inverse = reciprocal_sqrt(select(is_zero, one, squared_length));
    const Scalar length = squared_length * inverse;
    const Vector3<Scalar> u0(select(is_zero, one, Scalar(B(0, 0) * inverse)), B(1, 0) * inverse, B(2, 0) * inverse);
    const Vector3<Scalar> b1 = B.col(1) - u0 * u0.dot(B.col(1));
    const Scalar squared = b1.dot(b1);
    const auto is_rank_one = squared < Scalar(std::numeric_limits<RealOf<Scalar>>::min());
    const Scalar inverse_width = reciprocal_sqrt(select(is_rank_one, one, squared));
    const Scalar width = select(is_rank_one, zero, Scalar(squared * inverse_width));
    Vector3<Scalar> u1 = b1 * inverse_width;
    if (any_of(is_rank_one)) {
        const Vector3<Scalar> other = any_orthogonal(u0);
        for (int i = 0; i < 3; ++i) {
            u1(i) = select(is_rank_one, other(i), u1(i));
        }
    }
    result.U.col(0) = u0;
    result.U.col(1) = u1;
    result.U.col(2) = cross(u0, u1);
    // Rounding must not break the order of equal values.
    result.sigma(0) = length;
    result.sigma(1) = min(width, length);
    result.sigma(2) = max(Scalar(-result.sigma(1)), min(result.sigma(1), Scalar(result.U.col(2).dot(B.col(2)))));
}

}  // namespace detail

/// The singular value decomposition of F with proper rotations; see the file comment.
template <RealLanes Scalar>
Svd3<Scalar> svd3(const Matrix3<Scalar>& F) {
    using std::abs;
    using std::max;
    using Real = RealOf<Scalar>;
    const Scalar zero(0);
    Scalar largest(0);
    Scalar not_a_number(0);
    for (int k = 0; k < 9; ++k) {
        largest = max(largest, Scalar(abs(F.data()[k])));
        not_a_number += F.data()[k] * zero;
    }
    const auto is_finite = not_a_number == zero;
    const UnitScale<Scalar> scale(select(is_finite, largest, zero));
    Matrix3<Scalar> B;
    for (int k = 0; k < 9; ++k) {
        B.data()[k] = scale.unit(select(is_finite, F.data()[k], zero));
    }
    Svd3<Scalar> result;
    result.V = Matrix3<Scalar>::Identity();
    detail::turn_to_eigenvectors(B, result.V);
    constexpr int max_sweeps = 12;  // convergence is quadratic; 6 are met
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        const auto first = detail::orthogonalise_columns(B, result.V, 0, 1);
        const auto second = detail::orthogonalise_columns(B, result.V, 0, 2);
        const auto third = detail::orthogonalise_columns(B, result.V, 1, 2);
        if (!any_of(first | second | third)) {
            break;
        }
    }
    detail::sort_columns(B, result.V, 0, 1);
    detail::sort_columns(B, result.V, 0, 2);
    detail::sort_columns(B, result.V, 1, 2);
    detail::split_lengths(B, result);
    for (int k = 0; k < 3; ++k) {
        result.sigma(k) = scale.original(result.sigma(k));
    }
    if (!all_of(is_finite)) {
        const Scalar nan(std::numeric_limits<Real>::quiet_NaN());
        for (int k = 0; k < 9; ++k) {
            result.U.data()[k] = select(is_finite, result.U.data()[k], nan);
            result.V.data()[k] = select(is_finite, result.V.data()[k], nan);
        }
        for (int k = 0; k < 3; ++k) {
            result.sigma(k) = select(is_finite, result.sigma(k), nan);
        }
    }
    return result;
}

}  // namespace softtissue
