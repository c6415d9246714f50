// SPDX-License-Identifier: MIT
/// @file
/// Rotations in three forms: rotation vector (axis times angle), unit quaternion, rotation matrix.
///
/// What        conversions between the three, quaternion product and sign alignment.
/// Equation    q(r) = (cos(a/2), r sin(a/2)/a), a = |r|;   r(q) = 2 atan2(|v|, w) v/|v| for w >= 0
/// Shapes      quaternion 4 = (w, x, y, z); rotation vector 3 [rad]; rotation matrix 3x3.
/// Valid       any angle, beyond 2 pi included; derivatives with respect to r exist at r = 0 (series, not a guard).
///             Rotation vectors that are returned are principal: |r| <= pi.
/// Source      Shepperd 1978, "Quaternion from rotation matrix" (branch on the largest component)
/// Tests       tests/unit/linalg/quaternion_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>
#include <limits>

namespace softtissue {

/// (w, x, y, z).
template <class Scalar>
using Quaternion = Eigen::Matrix<Scalar, 4, 1>;

/// q(r) uses its series where |r|^4 is below this: the first dropped term of cos, a^6/46080, is then below
/// rounding in value (a^2 eps/24) and, relative to -a/4, in its derivative (24 a^4/46080 = eps).
template <RealScalar R>
inline constexpr R quaternion_series_limit = R(1920) * std::numeric_limits<R>::epsilon();

/// r(q) uses its series where (|v|/w)^6 is below this: the first dropped term of atan(t)/t is t^6/7.
template <RealScalar R>
inline constexpr R rotation_vector_series_limit = std::numeric_limits<R>::epsilon();

/// Unit quaternion of the rotation about `r` by |r|. The sign is that of the angle: 2 pi gives (-1, 0, 0, 0).
template <FieldScalar S>
Quaternion<S> quaternion_from_rotation_vector(const Vector3<S>& r) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const S a2 = r.dot(r);
    S w, sine_over_angle;
    if (value_of(a2) * value_of(a2) < quaternion_series_limit<RealOf<S>>) {
        w = S(1) - a2 / S(8) + a2 * a2 / S(384);
        sine_over_angle = S(0.5) - a2 / S(48) + a2 * a2 / S(3840);
    } else {
        const S angle = sqrt(a2);
        w = cos(angle / S(2));
        sine_over_angle = sin(angle / S(2)) / angle;
    }
    return {w, sine_over_angle * r(0), sine_over_angle * r(1), sine_over_angle * r(2)};
}

/// Principal rotation vector, |r| <= pi, of a quaternion of any length but zero.
template <FieldScalar S>
Vector3<S> rotation_vector_from_quaternion(const Quaternion<S>& q) {
    using std::atan2;
    using std::sqrt;
    const S w = value_of(q(0)) < 0 ? S(-q(0)) : q(0);
    Vector3<S> v = q.template tail<3>();
    if (value_of(q(0)) < 0) {
        v = -v;
    }
    const S v2 = v.dot(v);
    const RealOf<S> t2 = value_of(v2) / (value_of(w) * value_of(w));
    if (t2 * t2 * t2 < rotation_vector_series_limit<RealOf<S>>) {
        const S tangent2 = v2 / (w * w);
        return v * (S(2) / w * (S(1) - tangent2 / S(3) + tangent2 * tangent2 / S(5)));
    }
    const S length = sqrt(v2);
    return v * (S(2) * atan2(length, w) / length);
}

/// Rotation matrix of q / |q|, from q and 2 q / |q|^2.
template <FieldScalar S>
[[gnu::always_inline]] inline Matrix3<S> rotation_matrix_from_scaled_quaternions(const Quaternion<S>& q,
                                                                                 const Quaternion<S>& scaled) {
    const S one(1);
    const S wx = q(0) * scaled(1), wy = q(0) * scaled(2), wz = q(0) * scaled(3);
    const S xx = q(1) * scaled(1), xy = q(1) * scaled(2), xz = q(1) * scaled(3);
    const S yy = q(2) * scaled(2), yz = q(2) * scaled(3), zz = q(3) * scaled(3);
    Matrix3<S> R;
    R(0, 0) = one - (yy + zz);
    R(1, 0) = xy + wz;
    R(2, 0) = xz - wy;
    R(0, 1) = xy - wz;
    R(1, 1) = one - (xx + zz);
    R(2, 1) = yz + wx;
    R(0, 2) = xz + wy;
    R(1, 2) = yz - wx;
    R(2, 2) = one - (xx + yy);
    return R;
}

/// Rotation matrix of a unit quaternion.
template <FieldScalar S>
[[gnu::always_inline]] inline Matrix3<S> rotation_matrix_from_quaternion(const Quaternion<S>& q) {
    return rotation_matrix_from_scaled_quaternions<S>(q, S(2) * q);
}

/// Unit quaternion of a rotation matrix; its largest component is positive.
template <FieldScalar S>
Quaternion<S> quaternion_from_rotation_matrix(const Matrix3<S>& R) {
    using std::sqrt;
    // Row k below is 4 q_k q: the row with the largest diagonal entry divides by the largest component.
    const S one(1);
    const S xx = R(0, 0), yy = R(1, 1), zz = R(2, 2);
    const S trace = xx + yy + zz;
    const auto is_w = (trace >= xx) & (trace >= yy) & (trace >= zz);
    const auto is_x = (xx >= yy) & (xx >= zz);
    const auto is_y = yy >= zz;
    const auto choose = [&](const S& w, const S& x, const S& y, const S& z) {
        return select(is_w, w, select(is_x, x, select(is_y, y, z)));
    };
    const S w_x = R(2, 1) - R(1, 2), w_y = R(0, 2) - R(2, 0), w_z = R(1, 0) - R(0, 1);
    const S x_y = R(0, 1) + R(1, 0), x_z = R(0, 2) + R(2, 0), y_z = R(1, 2) + R(2, 1);
    Quaternion<S> q;
    q(0) = choose(one + trace, w_x, w_y, w_z);
    q(1) = choose(w_x, one + xx - yy - zz, x_y, x_z);
    q(2) = choose(w_y, x_y, one - xx + yy - zz, y_z);
    q(3) = choose(w_z, x_z, y_z, one - xx - yy + zz);
    return q * S(one / sqrt(S(q.dot(q))));
}

/// Rotation about `r` by |r| (Rodrigues' formula, through the half angle: no cancellation near zero).
template <FieldScalar S>
Matrix3<S> rotation_matrix_from_rotation_vector(const Vector3<S>& r) {
    return rotation_matrix_from_quaternion<S>(quaternion_from_rotation_vector(r));
}

/// Principal rotation vector, |r| <= pi, of a rotation matrix; accurate near 0 and near pi.
template <FieldScalar S>
Vector3<S> rotation_vector_from_rotation_matrix(const Matrix3<S>& R) {
    return rotation_vector_from_quaternion<S>(quaternion_from_rotation_matrix(R));
}

/// The quaternion of the rotation that applies `b` first, then `a`.
template <FieldScalar S>
[[gnu::always_inline]] inline Quaternion<S> quaternion_product(const Quaternion<S>& a, const Quaternion<S>& b) {
    return {
        a(0) * b(0) - a(1) * b(1) - a(2) * b(2) - a(3) * b(3), a(0) * b(1) + a(1) * b(0) + a(2) * b(3) - a(3) * b(2),
        a(0) * b(2) - a(1) * b(3) + a(2) * b(0) + a(3) * b(1), a(0) * b(3) + a(1) * b(2) - a(2) * b(1) + a(3) * b(0)};
}

/// q or -q, whichever lies in the hemisphere of `reference`; q where both are equally far.
template <FieldScalar S>
Quaternion<S> aligned_quaternion(const Quaternion<S>& q, const Quaternion<S>& reference) {
    return value_of(S(q.dot(reference))) < 0 ? Quaternion<S>(-q) : q;
}

/// Is R^T R = I within `tolerance` (largest entry) and det R > 0?
template <FieldScalar S>
bool is_rotation(const Matrix3<S>& R, RealOf<S> tolerance) {
    using std::abs;
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b <= a; ++b) {
            const RealOf<S> product = value_of(S(R.col(a).dot(R.col(b))));
            if (!(abs(product - RealOf<S>(a == b ? 1 : 0)) <= tolerance)) {
                return false;
            }
        }
    }
    const S det = R(0, 0) * (R(1, 1) * R(2, 2) - R(1, 2) * R(2, 1)) -
                  R(0, 1) * (R(1, 0) * R(2, 2) - R(1, 2) * R(2, 0)) + R(0, 2) * (R(1, 0) * R(2, 1) - R(1, 1) * R(2, 0));
    return value_of(det) > 0;
}

}  // namespace softtissue
