// SPDX-License-Identifier: MIT
#include <softtissue/linalg/quaternion.hpp>

#include <softtissue/core/dual.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
constexpr S epsilon = std::numeric_limits<S>::epsilon();
template <class S>
constexpr long double wide_epsilon = static_cast<long double>(epsilon<S>);
template <class S>
constexpr S pi = std::numbers::pi_v<S>;

/// Angles of every size, and those on both sides of where the series of q(r) ends (|r|^4 = limit).
template <class S>
std::vector<S> angles() {
    const S border = std::sqrt(std::sqrt(quaternion_series_limit<S>));
    return {S(0),    S(1e-30), S(1e-12),          S(1e-8),           S(1e-5), S(0.99) * border, border,
            S(1.01) * border, S(0.1), S(1), S(3), pi<S>, S(4), S(6.28), S(7), S(20)};
}

/// Rodrigues' formula, evaluated with more digits.
template <class S>
Matrix3<long double> rodrigues(const Vector3<S>& rotation_vector) {
    const Vector3<long double> r = rotation_vector.template cast<long double>();
    const long double a = std::sqrt(r.dot(r));
    Matrix3<long double> K;
    K << 0, -r(2), r(1), r(2), 0, -r(0), -r(1), r(0), 0;
    if (a == 0) {
        return Matrix3<long double>::Identity() + K;
    }
    const long double s = std::sin(a / 2);
    return Matrix3<long double>::Identity() + std::sin(a) / a * K + 2 * s * s / (a * a) * K * K;
}

}  // namespace

TEST_CASE_TEMPLATE("a quarter turn about z", S, float, double) {
    const Quaternion<S> q = quaternion_from_rotation_vector(Vector3<S>(0, 0, pi<S> / 2));
    CHECK((q - Quaternion<S>(std::sqrt(S(0.5)), 0, 0, std::sqrt(S(0.5)))).norm() <= 2 * epsilon<S>);
    const Matrix3<S> R = rotation_matrix_from_quaternion(q);
    CHECK((R * Vector3<S>(1, 0, 0) - Vector3<S>(0, 1, 0)).norm() <= 4 * epsilon<S>);
}

TEST_CASE_TEMPLATE("quaternion of a rotation vector: every component to rounding, at every angle", S, float, double) {
    const Vector3<S> axis = Vector3<S>(1, -2, 2) / S(3);
    for (const S angle : angles<S>()) {
        CAPTURE(angle);
        const Vector3<S> r = angle * axis;
        const Vector3<long double> exact_r = r.template cast<long double>();
        const long double a = std::sqrt(exact_r.dot(exact_r));
        const long double scale = a == 0 ? 0.5L : std::sin(a / 2) / a;
        const Quaternion<long double> q = quaternion_from_rotation_vector(r).template cast<long double>();
        // an angle rounded to S is off by |r| eps/2, and so is its sine
        const long double tolerance = (2 + std::abs(a)) * wide_epsilon<S>;
        CHECK(std::abs(q(0) - std::cos(a / 2)) <= tolerance);
        for (int d = 0; d < 3; ++d) {
            const long double exact = scale * exact_r(d);
            CHECK(std::abs(q(1 + d) - exact) <= tolerance * std::min(1.0L, std::abs(exact_r(d))));
        }
    }
}

TEST_CASE_TEMPLATE("derivative of q(r) on both sides of the series' end, and at zero", S, float, double) {
    using D = Dual<S, 3>;
    const Vector3<S> axis = Vector3<S>(1, -2, 2) / S(3);
    for (const S angle : angles<S>()) {
        CAPTURE(angle);
        const Vector3<S> r = angle * axis;
        const Quaternion<D> q = quaternion_from_rotation_vector(
            Vector3<D>(D::variable(r(0), 0), D::variable(r(1), 1), D::variable(r(2), 2)));
        const Vector3<long double> x = r.template cast<long double>();
        const long double a = std::sqrt(x.dot(x));
        const bool tiny = a < 1e-9L;  // the formulas below cancel there; the limit is I/2
        const long double sinc = tiny ? 0.5L : std::sin(a / 2) / a;
        const long double slope = tiny ? -1.0L / 24 : (std::cos(a / 2) / 2 - sinc) / (a * a);
        for (int i = 0; i < 3; ++i) {
            const size_t k = size_t(i);
            const long double tolerance = 8 * (1 + a) * wide_epsilon<S>;
            const long double dw = static_cast<long double>(q(0).derivative[k]);
            CHECK(std::abs(dw + sinc / 2 * x(i)) <= tolerance * std::min(1.0L, a));
            for (int d = 0; d < 3; ++d) {
                const long double exact = (d == i ? sinc : 0.0L) + slope * x(d) * x(i);
                CHECK(std::abs(static_cast<long double>(q(1 + d).derivative[k]) - exact) <= tolerance);
            }
        }
    }
}

TEST_CASE_TEMPLATE("full turns: the sign of the quaternion is that of the angle", S, float, double) {
    const Quaternion<S> one = quaternion_from_rotation_vector(Vector3<S>(2 * pi<S>, 0, 0));
    CHECK((one - Quaternion<S>(-1, 0, 0, 0)).norm() <= 4 * epsilon<S>);
    const Quaternion<S> two = quaternion_from_rotation_vector(Vector3<S>(0, 4 * pi<S>, 0));
    CHECK((two - Quaternion<S>(1, 0, 0, 0)).norm() <= 8 * epsilon<S>);
    const Vector3<S> r = rotation_vector_from_quaternion(quaternion_from_rotation_vector(Vector3<S>(0, 0, 5)));
    CHECK((r - Vector3<S>(0, 0, 5 - 2 * pi<S>)).norm() <= 8 * epsilon<S>);
}

TEST_CASE_TEMPLATE("rotation vector of a quaternion: relative accuracy at every angle below pi", S, float, double) {
    // (|v|/w)^6 = limit is the end of the series
    const S border = 2 * std::atan(std::pow(rotation_vector_series_limit<S>, S(1) / 6));
    for (const S angle : {S(1e-30), S(1e-12), S(1e-5), S(0.01), S(0.99) * border, S(1.01) * border, S(1), S(3.1)}) {
        CAPTURE(angle);
        const Vector3<S> r = angle * Vector3<S>(2, -1, 2) / S(3);
        for (const S sign : {S(1), S(-1)}) {
            const Vector3<S> back =
                rotation_vector_from_quaternion<S>(sign * quaternion_from_rotation_vector(r));
            // near pi, w = cos(a/2) is small but its rounding is eps |w|, so the angle keeps its digits
            CHECK((back - r).norm() <= 8 * epsilon<S> * angle);
        }
        const Quaternion<S> longer = S(3) * quaternion_from_rotation_vector(r);
        CHECK((rotation_vector_from_quaternion(longer) - r).norm() <= 8 * epsilon<S> * angle);
    }
}

TEST_CASE_TEMPLATE("a half turn has length pi", S, float, double) {
    CHECK(rotation_vector_from_quaternion(Quaternion<S>(0, 0, 1, 0)) == Vector3<S>(0, pi<S>, 0));
    CHECK(rotation_vector_from_quaternion(Quaternion<S>(1, 0, 0, 0)) == Vector3<S>(0, 0, 0));
}

TEST_CASE_TEMPLATE("rotation matrix of a rotation vector is Rodrigues' formula", S, float, double) {
    RandomGenerator random(7);
    for (const S angle : angles<S>()) {
        const Vector3<S> r = angle * random_unit<Vector3<S>>(random);
        const Matrix3<S> R = rotation_matrix_from_rotation_vector(r);
        CAPTURE(angle);
        CHECK(is_rotation(R, 12 * epsilon<S>));  // |q|^2 is off by up to 4 eps, R^T R by twice that
        const Matrix3<long double> difference = R.template cast<long double>() - rodrigues(r);
        CHECK(difference.norm() <= static_cast<long double>(4 + 2 * angle) * wide_epsilon<S>);
        const S first_order = std::abs(R(2, 1) - R(1, 2) - 2 * r(0));
        if (angle < S(1e-5)) {  // R - R^T = 2 [r]x (1 - a^2/6): relative accuracy for tiny angles
            CHECK(first_order <= 4 * epsilon<S> * angle + angle * angle * angle);
        }
    }
}

TEST_CASE_TEMPLATE("matrix to quaternion: all four branches, near the half turn and near zero", S, float, double) {
    RandomGenerator random(3);
    std::vector<Vector3<S>> vectors = {{S(1e-20), 0, 0}, {0, S(1e-9), 0}, {pi<S> - S(1e-3), 0, 0},
                                       {0, pi<S> - S(1e-3), 0}, {0, 0, pi<S> - S(1e-3)}};
    for (int i = 0; i < 200; ++i) {
        vectors.push_back(random_unit<Vector3<S>>(random) * S(random.uniform(0, 3.1)));
    }
    for (const Vector3<S>& r : vectors) {
        CAPTURE(r.transpose());
        const Matrix3<S> R = rotation_matrix_from_rotation_vector(r);
        const Quaternion<S> q = quaternion_from_rotation_matrix(R);
        CHECK(std::abs(q.norm() - 1) <= 2 * epsilon<S>);
        CHECK((rotation_matrix_from_quaternion(q) - R).norm() <= 16 * epsilon<S>);
        // R carries rounding of eps per entry, that is of eps in angle; tiny angles keep relative accuracy
        const S tolerance = 16 * epsilon<S> * std::min(S(1), r.norm());
        CHECK((rotation_vector_from_rotation_matrix(R) - r).norm() <= tolerance);
    }
    CHECK(quaternion_from_rotation_matrix(Matrix3<S>(Vector3<S>(1, -1, -1).asDiagonal())) == Quaternion<S>(0, 1, 0, 0));
    CHECK(quaternion_from_rotation_matrix(Matrix3<S>(Vector3<S>(-1, 1, -1).asDiagonal())) == Quaternion<S>(0, 0, 1, 0));
    CHECK(quaternion_from_rotation_matrix(Matrix3<S>(Vector3<S>(-1, -1, 1).asDiagonal())) == Quaternion<S>(0, 0, 0, 1));
}

TEST_CASE_TEMPLATE("product of quaternions is the product of matrices", S, float, double) {
    RandomGenerator random(5);
    for (int i = 0; i < 50; ++i) {
        const Quaternion<S> a = random_unit<Quaternion<S>>(random), b = random_unit<Quaternion<S>>(random);
        const Matrix3<S> product = rotation_matrix_from_quaternion(a) * rotation_matrix_from_quaternion(b);
        const Matrix3<S> difference = rotation_matrix_from_quaternion(quaternion_product(a, b)) - product;
        CHECK(difference.norm() <= 16 * epsilon<S>);
    }
}

TEST_CASE_TEMPLATE("alignment picks the hemisphere of the reference", S, float, double) {
    const Quaternion<S> reference(1, 0, 0, 0), near(S(0.8), S(0.6), 0, 0), far(S(-0.8), S(0.6), 0, 0);
    CHECK(aligned_quaternion(near, reference) == near);
    CHECK(aligned_quaternion(far, reference) == -far);
    const Quaternion<S> across(0, 1, 0, 0);
    CHECK(aligned_quaternion(across, reference) == across);
}

TEST_CASE_TEMPLATE("is_rotation refuses scale, shear, mirror and NaN", S, float, double) {
    const Matrix3<S> I = Matrix3<S>::Identity();
    CHECK(is_rotation(I, S(0)));
    CHECK_FALSE(is_rotation<S>(S(1.01) * I, S(1e-3)));
    CHECK(is_rotation<S>(S(1.01) * I, S(0.1)));
    CHECK_FALSE(is_rotation<S>(-I, S(1e-3)));
    Matrix3<S> shear = I;
    shear(0, 1) = S(0.1);
    CHECK_FALSE(is_rotation(shear, S(1e-3)));
    CHECK_FALSE(is_rotation<S>(Matrix3<S>::Constant(std::numeric_limits<S>::quiet_NaN()), S(1)));
}
