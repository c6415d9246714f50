// SPDX-License-Identifier: MIT
#include <softtissue/linalg/eigen_deflation3.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// The largest error of A V = V diag(values), V^T V = I and det V = 1; infinite where the values do not descend.
template <class S>
S decomposition_error(const Matrix3<S>& A, const Matrix3<S>& V, const Vector3<S>& values) {
    const Matrix3<double> a = A.template cast<double>(), v = V.template cast<double>();
    const Vector3<double> l = values.template cast<double>();
    const Matrix3<double> rest = a * v - v * l.asDiagonal(), gram = v.transpose() * v - Matrix3<double>::Identity();
    const double slack = 8 * double(std::numeric_limits<S>::epsilon());
    const bool descends = l(0) + slack >= l(1) && l(1) + slack >= l(2);
    return descends ? S(std::max({rest.norm(), gram.norm(), std::abs(v.determinant() - 1)}))
                    : std::numeric_limits<S>::infinity();
}

/// Symmetric, the largest entry 1 in size or all zero.
template <class S>
Matrix3<S> scaled(const Matrix3<S>& A) {
    const S largest = A.cwiseAbs().maxCoeff();
    return largest > S(0) ? Matrix3<S>((A + A.transpose()) / (S(2) * largest)) : A;
}

/// With eigenvalues apart, double, triple, zero, of rank one, nearly so by every power of two, and graded.
template <class S>
std::vector<Matrix3<S>> hard_matrices(RandomGenerator& random) {
    std::vector<Matrix3<S>> list{Matrix3<S>::Zero(), Matrix3<S>::Identity(), -Matrix3<S>::Identity(),
                                 Matrix3<S>::Ones(), -Matrix3<S>::Ones()};
    for (int axis = 0; axis < 3; ++axis) {
        list.push_back(Vector3<S>::Unit(axis).asDiagonal());
        list.push_back((Vector3<S>::Ones() - S(2) * Vector3<S>::Unit(axis)).asDiagonal());
    }
    for (int power = 0; power <= std::numeric_limits<S>::digits + 8; ++power) {
        const S gap = std::ldexp(S(1), -power);
        for (const Vector3<S>& values : {Vector3<S>(1, S(1) - gap, S(0.3)), Vector3<S>(1, S(-0.3), S(-0.3) - gap),
                                         Vector3<S>(1, S(1) - gap, S(1) + gap), Vector3<S>(1, gap, -gap),
                                         Vector3<S>(1, gap, gap * gap), Vector3<S>(-1, S(1) - gap, 0)}) {
            list.push_back(scaled<S>(values.asDiagonal()));
            const Matrix3<S> Q = random_rotation<S>(random);
            list.push_back(scaled<S>(Q * values.asDiagonal() * Q.transpose()));
        }
    }
    for (int sample = 0; sample < 2000; ++sample) {
        list.push_back(scaled<S>(random_normal<Matrix3<S>>(random)));
    }
    return list;
}

}  // namespace

TEST_CASE_TEMPLATE("every symmetric matrix is decomposed to a few epsilon, values descending", Scalar, float, double) {
    RandomGenerator random(1);
    for (const Matrix3<Scalar>& A : hard_matrices<Scalar>(random)) {
        Matrix3<Scalar> V = A;
        const Vector3<Scalar> values = diagonalise_by_deflation(V);
        CAPTURE(A);
        CHECK(decomposition_error(A, V, values) < Scalar(16) * std::numeric_limits<Scalar>::epsilon());
    }
}

TEST_CASE_TEMPLATE("many side by side are decomposed as one, whatever their neighbours are", Scalar, float, double) {
    constexpr int N = natural_lanes<Scalar>;
    using Lanes = Pack<Scalar, N>;
    RandomGenerator random(2);
    const std::vector<Matrix3<Scalar>> list = hard_matrices<Scalar>(random);
    for (std::size_t first = 0; first + N <= list.size(); first += N) {
        Matrix3<Lanes> V, W;
        for (int k = 0; k < 9; ++k) {
            V.data()[k] = Lanes::from_lanes([&](int lane) { return list[first + std::size_t(lane)].data()[k]; });
            W.data()[k] = Lanes(list[first].data()[k]);
        }
        const Vector3<Lanes> values = diagonalise_by_deflation(V), alone = diagonalise_by_deflation(W);
        for (int lane = 0; lane < N; ++lane) {
            Matrix3<Scalar> one;
            Vector3<Scalar> of_one;
            for (int k = 0; k < 9; ++k) {
                one.data()[k] = V.data()[k][lane];
            }
            for (int k = 0; k < 3; ++k) {
                of_one(k) = values(k)[lane];
            }
            CHECK(decomposition_error(list[first + std::size_t(lane)], one, of_one) <
                  Scalar(16) * std::numeric_limits<Scalar>::epsilon());
        }
        for (int k = 0; k < 3; ++k) {
            CHECK(values(k)[0] == alone(k)[0]);
        }
    }
}

TEST_CASE_TEMPLATE("only the lower triangle is read", Scalar, float, double) {
    RandomGenerator random(3);
    const Matrix3<Scalar> A = scaled<Scalar>(random_normal<Matrix3<Scalar>>(random));
    Matrix3<Scalar> V = A, lower = A;
    lower(0, 1) = lower(0, 2) = lower(1, 2) = std::numeric_limits<Scalar>::quiet_NaN();
    CHECK(diagonalise_by_deflation(V) == diagonalise_by_deflation(lower));
    CHECK(V == lower);
}
