// SPDX-License-Identifier: MIT
/// @file
/// Eigenvalues and eigenvectors of a small symmetric matrix: by Jacobi rotations up to 4 x 4, beyond by QL steps.
///
/// What        H = V diag(values) V^T; values in no particular order, V orthogonal.
/// Shapes      H, V: N x N, N up to about a dozen; only the lower triangle of H is read
/// Valid       every finite H. Up to 4 x 4 small eigenvalues of graded matrices keep their relative accuracy. Where H is not
///             finite, all is NaN. No finite matrix was met that needs the last of the sweeps or steps that are allowed.
///             Packs: a converged lane stands still while others go on, so that it never depends on them.
/// Source      Golub & Van Loan 2013, sec. 8.5 (Jacobi); tridiagonal_ql.hpp
/// Why         plain loops: a fixed-size 9x9 eigensolver of Eigen costs eleven seconds of compile time, this one none
/// Cost        Jacobi: 5 to 8 sweeps of N (N - 1) / 2 rotations, 9 N flop each
/// Tests       tests/unit/linalg/symmetric_eigen_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/jacobi_rotation.hpp>
#include <softtissue/linalg/tridiagonal_ql.hpp>
#include <softtissue/linalg/unit_scale.hpp>

#include <cmath>
#include <limits>

namespace softtissue {

template <RealLanes Scalar, int N>
struct SymmetricEigen {
    Eigen::Matrix<Scalar, N, 1> values;
    Eigen::Matrix<Scalar, N, N> vectors;
};

namespace detail {

/// The entry of the lower triangle that holds H(i, j).
template <class Scalar, int N>
Scalar& lower_entry(Eigen::Matrix<Scalar, N, N>& H, int i, int j) {
    return i >= j ? H(i, j) : H(j, i);
}

/// Makes H(q, p), p < q, zero where `is_off`: H <- G^T H G, V <- V G; of H the lower triangle.
template <class Scalar, class Mask, int N>
void jacobi_rotate(const Mask& is_off, Eigen::Matrix<Scalar, N, N>& H, Eigen::Matrix<Scalar, N, N>& V, int p, int q) {
    const Scalar zero(0), one(1);
    const JacobiRotation<Scalar> rotation(Scalar(H(q, q) - H(p, p)), Scalar(H(q, p) + H(q, p)));
    const Scalar c = select(is_off, rotation.cosine, one);
    const Scalar s = select(is_off, rotation.sine, zero);
    const Scalar t = select(is_off, rotation.tangent, zero);
    const auto turn = [&](Scalar& a, Scalar& b) {
        const Scalar old = a;
        a = c * old - s * b;
        b = s * old + c * b;
    };
    const Scalar shift = t * H(q, p);
    H(p, p) -= shift;
    H(q, q) += shift;
    H(q, p) = select(is_off, zero, H(q, p));
    for (int i = 0; i < N; ++i) {
        if (i != p && i != q) {
            turn(lower_entry(H, i, p), lower_entry(H, i, q));
        }
        turn(V(i, p), V(i, q));
    }
}

/// A, entries at most 1 in size, becomes the matrix of its eigenvectors; the eigenvalues. As diagonalise_by_ql().
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, 1> diagonalise_by_rotations(Eigen::Matrix<Scalar, N, N>& A) {
    constexpr int max_sweeps = 30;  // quadratic convergence: eight are enough, the rest is for denormals
    using std::abs;
    using Limits = std::numeric_limits<RealOf<Scalar>>;
    Eigen::Matrix<Scalar, N, N> H = A;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            A(i, j) = Scalar(i == j ? 1 : 0);
        }
    }
    // below half an ulp of both diagonal entries a rotation changes nothing
    const Scalar smallest(Limits::min()), threshold(Limits::epsilon() * Limits::epsilon() / RealOf<Scalar>(16));
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        bool is_diagonal = true;
        for (int p = 0; p < N; ++p) {
            for (int q = p + 1; q < N; ++q) {
                const Scalar squared = H(q, p) * H(q, p);
                const Scalar size = abs(H(p, p) * H(q, q));
                const auto is_off = (squared > threshold * size) & (squared > smallest);
                if (any_of(is_off)) {
                    is_diagonal = false;
                    jacobi_rotate(is_off, H, A, p, q);
                }
            }
        }
        if (is_diagonal) {
            break;
        }
    }
    Eigen::Matrix<Scalar, N, 1> values;
    for (int i = 0; i < N; ++i) {
        values(i) = H(i, i);
    }
    return values;
}

}  // namespace detail

template <RealLanes Scalar, int N>
SymmetricEigen<Scalar, N> symmetric_eigen(const Eigen::Matrix<Scalar, N, N>& lower) {
    using std::abs;
    using std::max;
    const Scalar zero(0);
    Scalar largest(0), not_a_number(0);
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            largest = max(largest, Scalar(abs(lower(i, j))));
            not_a_number += lower(i, j) * zero;
        }
    }
    // With a largest entry of 1 no square leaves the range of the scalar.
    const UnitScale<Scalar> scale(largest);
    SymmetricEigen<Scalar, N> result;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            result.vectors(i, j) = result.vectors(j, i) = scale.unit(lower(i, j));
        }
    }
    if constexpr (N > 4) {
        result.values = diagonalise_by_ql(result.vectors);
    } else {
        result.values = detail::diagonalise_by_rotations(result.vectors);
    }
    for (int i = 0; i < N; ++i) {
        result.values(i) = scale.original(result.values(i)) + not_a_number;
    }
    if (!all_of(not_a_number == zero)) {
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) {
                result.vectors(i, j) += not_a_number;
            }
        }
    }
    return result;
}

}  // namespace softtissue
