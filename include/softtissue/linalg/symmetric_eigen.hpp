// SPDX-License-Identifier: MIT
/// @file
/// Eigenvalues and eigenvectors of a small symmetric matrix: 3 x 3 by deflation, others by QL steps.
///
/// What        H = V diag(values) V^T; values in no particular order, V orthogonal.
/// Shapes      H, V: N x N, N up to about a dozen; only the lower triangle of H is read
/// Valid       every finite H. Where H is not finite, all is NaN. No finite matrix was met that needs the last of the steps
///             that are allowed.  Packs: no lane depends on the others.
/// Accuracy    a few epsilon |H|; small eigenvalues have no relative accuracy
/// Source      eigen_deflation3.hpp, tridiagonal_ql.hpp
/// Why         plain loops: a fixed-size 9x9 eigensolver of Eigen costs eleven seconds of compile time, this one none
/// Cost        200 flop (3 x 3); about 9 N^3 multiply-adds
/// Tests       tests/unit/linalg/symmetric_eigen_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/eigen_deflation3.hpp>
#include <softtissue/linalg/tridiagonal_ql.hpp>
#include <softtissue/linalg/unit_scale.hpp>

namespace softtissue {

template <RealLanes Scalar, int N>
struct SymmetricEigen {
    Eigen::Matrix<Scalar, N, 1> values;
    Eigen::Matrix<Scalar, N, N> vectors;
};

template <RealLanes Scalar, int N>
    requires(N > 1)
SymmetricEigen<Scalar, N> symmetric_eigen(const Eigen::Matrix<Scalar, N, N>& lower) {
    const Scalar zero(0);
    Scalar not_a_number(0);
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            not_a_number += lower(i, j) * zero;
        }
    }
    SymmetricEigen<Scalar, N> result;
    if constexpr (N == 3) {
        const UnitScale<Scalar> scale(largest_entry(lower));
        for (int j = 0; j < N; ++j) {
            for (int i = j; i < N; ++i) {
                result.vectors(i, j) = scale.unit(lower(i, j));
            }
        }
        result.values = diagonalise_by_deflation(result.vectors);
        for (int i = 0; i < N; ++i) {
            result.values(i) = scale.original(result.values(i));
        }
    } else {
        result.vectors = lower;
        result.values = diagonalise_by_ql(result.vectors);
    }
    for (int i = 0; i < N; ++i) {
        result.values(i) += not_a_number;
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
