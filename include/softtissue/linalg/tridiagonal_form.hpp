// SPDX-License-Identifier: MIT
/// @file
/// Makes a small symmetric matrix tridiagonal by Householder's reflections.
///
/// What        A = size Q T Q^T: the diagonal of T, what is below it, and Q as the reflections that it is the product of
/// Equation    Q = P_0 P_1 ... P_{N-3},  P_k = I - factors(k) v v^T with v = column k of `reflections` below row k
/// Shapes      A: N x N, N > 1, of which the lower triangle is read; diagonal, below: N, below(N - 1) = 0
/// Valid       every finite A: it is scaled to a largest entry of 1, which no square takes out of range. A column whose tail is below the smallest normal number over epsilon stays as it is
/// Accuracy    a few epsilon |A|
/// Packs       no branch: no lane depends on the others
/// Source      Golub & Van Loan 2013, sec. 8.3
/// Cost        2/3 N^3 multiply-adds; 2 N^2 for the product of Q and a vector
/// Tests       tests/unit/linalg/tridiagonal_form_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/unit_scale.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace softtissue {

template <RealLanes Scalar, int N>
    requires(N > 1)
struct TridiagonalForm {
    using Vector = Eigen::Matrix<Scalar, N, 1>;

    explicit TridiagonalForm(const Eigen::Matrix<Scalar, N, N>& lower);

    /// Eigenvalue y of T as one of A.
    Scalar original(const Scalar& y) const { return scale.original(y); }

    /// v becomes Q v.
    void apply_reflections(Vector& v) const;

    UnitScale<Scalar> scale;
    Vector diagonal, below;
    Eigen::Matrix<Scalar, N, N> reflections;
    Vector factors;
};

template <RealLanes Scalar, int N>
    requires(N > 1)
TridiagonalForm<Scalar, N>::TridiagonalForm(const Eigen::Matrix<Scalar, N, N>& lower) : scale(largest_entry(lower)) {
    using std::abs;
    using std::copysign;
    using std::sqrt;
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    const Scalar zero(0), one(1), half(RealOf<Scalar>(0.5));
    const Scalar smallest(Limits::min() / Limits::epsilon());
    auto& A = reflections;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            A(i, j) = scale.unit(lower(i, j));
        }
    }
    Vector p;
    for (int k = 0; k + 2 < N; ++k) {
        Scalar tail(0);
        for (int i = k + 2; i < N; ++i) {
            tail += A(i, k) * A(i, k);
        }
        const Scalar x = A(k + 1, k);
        const Scalar squared = x * x + tail;
        const Scalar length = sqrt(squared);
        const auto is_reduced = tail <= smallest;
        const Scalar factor = select(is_reduced, zero, Scalar(one / (squared + abs(x) * length)));
        diagonal(k) = A(k, k);
        below(k) = select(is_reduced, x, Scalar(-copysign(length, x)));
        factors(k) = factor;
        A(k + 1, k) = x + copysign(length, x);
        // A <- A - v w^T - w v^T, w = p - factor/2 (p^T v) v, p = factor A v
        for (int i = k + 1; i < N; ++i) {
            p(i) = zero;
        }
        for (int j = k + 1; j < N; ++j) {
            const Scalar v = A(j, k);
            Scalar sum = A(j, j) * v;
            for (int i = j + 1; i < N; ++i) {
                p(i) += A(i, j) * v;
                sum += A(i, j) * A(i, k);
            }
            p(j) += sum;
        }
        Scalar dot(0);
        for (int i = k + 1; i < N; ++i) {
            p(i) *= factor;
            dot += p(i) * A(i, k);
        }
        const Scalar part = half * factor * dot;
        for (int i = k + 1; i < N; ++i) {
            p(i) -= part * A(i, k);
        }
        for (int j = k + 1; j < N; ++j) {
            const Scalar v = A(j, k), w = p(j);
            for (int i = j; i < N; ++i) {
                A(i, j) -= A(i, k) * w + p(i) * v;
            }
        }
    }
    diagonal(N - 2) = A(N - 2, N - 2);
    diagonal(N - 1) = A(N - 1, N - 1);
    below(N - 2) = A(N - 1, N - 2);
    below(N - 1) = zero;
}

template <RealLanes Scalar, int N>
    requires(N > 1)
void TridiagonalForm<Scalar, N>::apply_reflections(Vector& v) const {
    for (int k = N - 3; k >= 0; --k) {
        Scalar dot(0);
        for (int i = k + 1; i < N; ++i) {
            dot += reflections(i, k) * v(i);
        }
        dot *= factors(k);
        for (int i = k + 1; i < N; ++i) {
            v(i) -= dot * reflections(i, k);
        }
    }
}

}  // namespace softtissue
