// SPDX-License-Identifier: MIT
/// @file
/// Diagonalises a small symmetric matrix by Householder's tridiagonal form and implicit QL steps.
///
/// What        A = Q diag(values) Q^T: A becomes Q, whose columns are the eigenvectors; values in no particular order
/// Equation    reflections I - b v v^T make A tridiagonal; QL steps with Wilkinson's shift make that diagonal
/// Shapes      A: N x N, of which the lower triangle is read; values: N
/// Valid       entries at most 1 in size; what the form has below the diagonal counts as zero where it is below epsilon^2
/// Accuracy    a few epsilon |A|, for small eigenvalues too: not relative to each, as by Jacobi rotations
/// Packs       a lane whose eigenvalue is found stands still while others go on, so that it never depends on them
/// Source      Golub & Van Loan 2013, sec. 8.3; the step: Martin, Wilkinson 1968, "The Implicit QL Algorithm"
/// Cost        4/3 N^3 multiply-adds for the form, as many for its vectors, about 2 N^2 rotations of N entries: a third of Jacobi's
/// Tests       tests/unit/linalg/tridiagonal_ql_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace softtissue {

namespace detail {

/// The diagonal and what is below it.
template <class Scalar, int N>
struct Tridiagonal {
    Eigen::Matrix<Scalar, N, 1> diagonal, below;
};

/// Reduces A; its columns below the diagonal become the vectors v of the reflections, `factors` their b.
template <class Scalar, int N>
Tridiagonal<Scalar, N> tridiagonal_form(Eigen::Matrix<Scalar, N, N>& A, Eigen::Matrix<Scalar, N, 1>& factors) {
    using std::abs;
    using std::copysign;
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    const Scalar zero(0), half(RealOf<Scalar>(0.5));
    const Scalar smallest(Limits::min() / Limits::epsilon());
    Tridiagonal<Scalar, N> T;
    Eigen::Matrix<Scalar, N, 1> p;
    for (int k = 0; k + 2 < N; ++k) {
        Scalar tail(0);
        for (int i = k + 2; i < N; ++i) {
            tail += A(i, k) * A(i, k);
        }
        const Scalar x = A(k + 1, k);
        const Scalar length = quick_sqrt(Scalar(x * x + tail));
        const auto is_reduced = tail <= smallest;
        const Scalar b = select(is_reduced, zero, reciprocal(Scalar(length * (length + abs(x)))));
        T.diagonal(k) = A(k, k);
        T.below(k) = select(is_reduced, x, Scalar(-copysign(length, x)));
        factors(k) = b;
        A(k + 1, k) = x + copysign(length, x);
        // A <- A - v w^T - w v^T, w = p - b/2 (p^T v) v, p = b A v
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
            p(i) *= b;
            dot += p(i) * A(i, k);
        }
        const Scalar part = half * b * dot;
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
    T.diagonal(N - 2) = A(N - 2, N - 2);
    T.diagonal(N - 1) = A(N - 1, N - 1);
    T.below(N - 2) = A(N - 1, N - 2);
    T.below(N - 1) = zero;
    return T;
}

/// The product of the reflections.
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, N> product_of_reflections(const Eigen::Matrix<Scalar, N, N>& A,
                                                   const Eigen::Matrix<Scalar, N, 1>& factors) {
    Eigen::Matrix<Scalar, N, N> Q;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            Q(i, j) = Scalar(i == j ? 1 : 0);
        }
    }
    for (int k = N - 3; k >= 0; --k) {
        for (int j = k + 1; j < N; ++j) {
            Scalar dot(0);
            for (int i = k + 1; i < N; ++i) {
                dot += A(i, k) * Q(i, j);
            }
            dot *= factors(k);
            for (int i = k + 1; i < N; ++i) {
                Q(i, j) -= dot * A(i, k);
            }
        }
    }
    return Q;
}

/// Where the entry below diagonal entry i counts.
template <class Scalar, int N>
auto is_coupled(const Tridiagonal<Scalar, N>& T, int i) {
    using std::abs;
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    const Scalar size = abs(T.diagonal(i)) + abs(T.diagonal(i + 1)) + Scalar(Limits::epsilon());
    return abs(T.below(i)) > size * Scalar(Limits::epsilon());
}

/// One QL step on the rows from `first` on where `is_active`: of each block that is coupled, with the shift for `first`.
template <class Scalar, class Mask, int N>
void ql_step(const Mask& is_active, int first, Tridiagonal<Scalar, N>& T, Eigen::Matrix<Scalar, N, N>& Q) {
    using std::copysign;
    const Scalar zero(0), one(1);
    const Scalar smallest(std::numeric_limits<RealOf<Scalar>>::min());
    auto& d = T.diagonal;
    auto& e = T.below;
    const Scalar ratio = (d(first + 1) - d(first)) * reciprocal(Scalar(e(first) + e(first)));
    const Scalar root = quick_sqrt(Scalar(ratio * ratio + one));
    const Scalar shift = d(first) - e(first) * reciprocal(Scalar(ratio + copysign(root, ratio)));
    Scalar s = one, c = one, p = zero, g = zero;
    auto is_inside = one < zero;  // a block that began above
    Eigen::Matrix<Scalar, N, 1> column = Q.col(N - 1);
    for (int i = N - 2; i >= first; --i) {
        s = select(is_inside, s, one);
        c = select(is_inside, c, one);
        p = select(is_inside, p, zero);
        g = select(is_inside, g, Scalar(d(i + 1) - shift));
        const Scalar f = s * e(i), b = c * e(i);
        const Scalar squared = f * f + g * g;
        const Scalar inverse = reciprocal_sqrt(squared);
        const auto is_linked = is_coupled(T, i);
        const auto is_turning = is_active & is_linked & (squared >= smallest);
        s = select(is_turning, Scalar(f * inverse), zero);
        c = select(is_turning, Scalar(g * inverse), one);
        const Scalar outer = select(is_inside, select(is_turning, Scalar(squared * inverse), g), zero);
        e(i + 1) = select(is_active, outer, e(i + 1));
        is_inside = is_linked;
        const Scalar rest = d(i + 1) - p;
        const Scalar r = (d(i) - rest) * s + c * (b + b);
        p = s * r;
        d(i + 1) = select(is_active, Scalar(rest + p), d(i + 1));
        g = c * r - b;
        for (int row = 0; row < N; ++row) {
            const Scalar q = Q(row, i);
            Q(row, i + 1) = s * q + c * column(row);
            column(row) = c * q - s * column(row);
        }
    }
    Q.col(first) = column;
    d(first) = select(is_active, Scalar(d(first) - p), d(first));
    e(first) = select(is_active, g, e(first));
}

}  // namespace detail

/// A becomes the matrix of its eigenvectors; the eigenvalues.
template <RealLanes Scalar, int N>
    requires(N >= 2)
Eigen::Matrix<Scalar, N, 1> diagonalise_by_ql(Eigen::Matrix<Scalar, N, N>& A) {
    constexpr int max_steps = 30;  // two an eigenvalue are usual
    Eigen::Matrix<Scalar, N, 1> factors;
    detail::Tridiagonal<Scalar, N> T = detail::tridiagonal_form(A, factors);
    A = detail::product_of_reflections(A, factors);
    for (int first = 0; first + 1 < N; ++first) {
        for (int step = 0; step < max_steps; ++step) {
            const auto is_active = detail::is_coupled(T, first);
            if (!any_of(is_active)) {
                break;
            }
            detail::ql_step(is_active, first, T, A);
        }
    }
    return T.diagonal;
}

}  // namespace softtissue
