// SPDX-License-Identifier: MIT
#include <softtissue/linalg/matrix_exponential.hpp>

#include "exponential_reference.hpp"

#include <softtissue/core/dual.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <support/reference_case.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
double epsilons(const Matrix3<S>& X, const ExactMatrix3& exact) {
    const ExactMatrix3 difference = X.template cast<long double>() - exact;
    return double(difference.norm() / exact.norm()) / double(std::numeric_limits<S>::epsilon());
}

/// Matrices of one Frobenius norm, and the error that is allowed.
struct NormCase {
    double size, tolerance;
};

}  // namespace

TEST_CASE_TEMPLATE("a few ulp of the norm for matrices of every kind", S, float, double) {
    for (const NormCase& norm : {NormCase{1e-6, 2.0}, {0.1, 2.0}, {1.0, 2.5}, {1.99, 3.0}, {3.5, 5.0}, {10.0, 12.0}}) {
        RandomGenerator random(1);
        double worst = 0;
        for (int i = 0; i < 4000; ++i) {
            const Matrix3<S> Q = random_matrix_of_kind<S>(random, i % num_matrix_kinds, norm.size);
            worst = std::max(worst, epsilons(matrix_exponential(Q), exact_exponential(Q)));
        }
        CAPTURE(norm.size);
        CHECK(worst < (sizeof(S) == 4 ? std::min(norm.tolerance, 3.0) : norm.tolerance));
    }
}

TEST_CASE_TEMPLATE("the pullback to a few ulp of |exp Q| |G|", S, float, double) {
    for (const NormCase& norm : {NormCase{1e-6, 1.5}, {0.1, 1.5}, {1.0, 2.0}, {1.99, 2.0}, {3.5, 3.0}, {10.0, 8.0}}) {
        RandomGenerator random(2);
        double worst = 0;
        for (int i = 0; i < 1000; ++i) {
            const Matrix3<S> Q = random_matrix_of_kind<S>(random, i % num_matrix_kinds, norm.size);
            const Matrix3<S> G = random_normal<Matrix3<S>>(random);
            const ExactMatrix3 exact = exact_derivative(Matrix3<S>(Q.transpose()), G);
            worst = std::max(worst,
                             double((matrix_exponential_pullback(Q, G).template cast<long double>() - exact).norm()) /
                                 double(exact_exponential(Q).norm()) / double(G.norm()) /
                                 double(std::numeric_limits<S>::epsilon()));
        }
        CAPTURE(norm.size);
        CHECK(worst < norm.tolerance);
    }
}

TEST_CASE_TEMPLATE("rotations, determinants, inverses", S, float, double) {
    RandomGenerator random(3);
    const S epsilon = std::numeric_limits<S>::epsilon();
    CHECK(matrix_exponential<S>(Matrix3<S>::Zero()) == Matrix3<S>::Identity());
    for (int i = 0; i < 200; ++i) {
        const Vector3<S> axis = S(i) * S(0.02) * random_unit<Vector3<S>>(random);
        const Matrix3<S> K =
            (Matrix3<S>() << 0, -axis(2), axis(1), axis(2), 0, -axis(0), -axis(1), axis(0), 0).finished();
        CHECK((matrix_exponential(K) - rotation_matrix_from_rotation_vector(axis)).norm() <= 12 * epsilon);
        const Matrix3<S> Q = random_matrix_of_kind<S>(random, i % num_matrix_kinds, random.uniform(0, 2));
        const Matrix3<S> X = matrix_exponential(Q);
        CHECK(std::abs(X.determinant() / std::exp(Q.trace()) - 1) <= 400 * epsilon);
        CHECK(X.determinant() > S(0));
        CHECK((X * matrix_exponential<S>(-Q) - Matrix3<S>::Identity()).norm() <= 200 * epsilon);
    }
}

TEST_CASE_TEMPLATE("finite wherever the exponential is", S, float, double) {
    const S epsilon = std::numeric_limits<S>::epsilon();
    const auto exp_diagonal = [](S a, S b, S c) { return matrix_exponential<S>(Vector3<S>(a, b, c).asDiagonal()); };
    CHECK((exp_diagonal(S(-3000), 0, S(-1)) - Matrix3<S>(Vector3<S>(0, 1, std::exp(S(-1))).asDiagonal())).norm() <=
          3000 * epsilon);
    CHECK((exp_diagonal(S(-1e9), 0, 0) - Matrix3<S>(Vector3<S>(0, 1, 1).asDiagonal())).norm() <= S(1e-5));
    CHECK(exp_diagonal(S(-1e9), S(-1e9), S(-1e9)).norm() <= S(1e-5));
    CHECK(exp_diagonal(S(-80), S(-80), S(-80))(1, 1) ==
          doctest::Approx(double(std::exp(S(-80)))).epsilon(100 * double(epsilon)));
    const S hot = sizeof(S) == 4 ? S(85) : S(700);
    CHECK(exp_diagonal(hot, -hot, 0)(0, 0) == doctest::Approx(double(std::exp(hot))).epsilon(1000 * double(epsilon)));
    Matrix3<S> nilpotent = Matrix3<S>::Zero();
    for (const S entry : {S(10), S(1e5), S(1e9)}) {
        nilpotent(0, 2) = entry;
        CHECK(matrix_exponential(nilpotent) == Matrix3<S>(Matrix3<S>::Identity() + nilpotent));
        CHECK(matrix_exponential_pullback(nilpotent, Matrix3<S>(Matrix3<S>::Identity())).allFinite());
    }
    CHECK(!exp_diagonal(S(1e6), 0, 0).allFinite());
    CHECK(std::isnan(exp_diagonal(std::numeric_limits<S>::quiet_NaN(), 0, 0)(0, 0)));
}

TEST_CASE("the pullback is the gradient, with and without squarings") {
    for (const double norm : {0.3, 2.0, 7.0}) {
        RandomGenerator random(4);
        const auto Q = random_matrix_of_kind<double>(random, 0, norm), G = random_normal<Matrix3<double>>(random);
        const auto dQ = random_unit<Matrix3<double>>(random);
        const auto along = [&](double h) { return matrix_exponential<double>(Q + h * dQ).cwiseProduct(G).sum(); };
        const double slope = matrix_exponential_pullback<double>(Q, G).cwiseProduct(dQ).sum();
        CHECK(taylor_rate(along, slope).is_at_least(2));
        CHECK(!taylor_rate(along, 1.001 * slope).is_at_least(2));
    }
}

TEST_CASE("numbers that carry derivatives") {
    using D = Dual<double, 1>;
    for (const double norm : {0.7, 5.0}) {
        RandomGenerator random(5);
        const auto Q = random_matrix_of_kind<double>(random, 0, norm), dQ = random_unit<Matrix3<double>>(random);
        const auto G = random_normal<Matrix3<double>>(random);
        Matrix3<D> carrying;
        for (int i = 0; i < 9; ++i) {
            carrying(i) = D(Q(i), {dQ(i)});
        }
        const Matrix3<D> X = matrix_exponential(carrying);
        double derivative = 0, scale = 0;
        for (int i = 0; i < 9; ++i) {
            CHECK(X(i).value == doctest::Approx(matrix_exponential<double>(Q)(i)).epsilon(1e-13));
            derivative += X(i).derivative[0] * G(i);
            scale += std::abs(X(i).derivative[0] * G(i));
        }
        CHECK(std::abs(derivative - matrix_exponential_pullback<double>(Q, G).cwiseProduct(dQ).sum()) <= 1e-13 * scale);
    }
}

#if __has_include(<zip.h>)
TEST_CASE("agrees with independent software") {
    if (const auto reference = reference_case("o5_matexp.npz")) {
        const auto A = reference->at("A").matrices<double, 3, 3>(), X = reference->at("expA").matrices<double, 3, 3>();
        const auto G = reference->at("G").matrices<double, 3, 3>(), vjp = reference->at("vjp").matrices<double, 3, 3>();
        double value = 0, gradient = 0;
        for (size_t i = 0; i < A.size(); ++i) {
            value = std::max(value, (matrix_exponential<double>(A[i]) - X[i]).norm() / X[i].norm());
            gradient =
                std::max(gradient, (matrix_exponential_pullback<double>(A[i], G[i]) - vjp[i]).norm() / vjp[i].norm());
        }
        MESSAGE(A.size(), " matrices: value ", value, ", gradient ", gradient);
        CHECK(value <= 1e-14);
        CHECK(gradient <= 2e-14);
    }
}
#endif
