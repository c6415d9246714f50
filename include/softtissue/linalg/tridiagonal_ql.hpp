// SPDX-License-Identifier: MIT
/// @file
/// Diagonalises a small symmetric matrix by Householder's tridiagonal form and implicit QL steps.
///
/// What        A = Q diag(values) Q^T: A becomes Q, whose columns are the eigenvectors; values in no particular order
/// Equation    QL steps with Wilkinson's shift make the tridiagonal form diagonal, row by row from the top
/// Shapes      A: N x N, of which the lower triangle is read; values: N
/// Valid       every finite A
/// Accuracy    a few epsilon |A|, for small eigenvalues too: not relative to each, as by Jacobi rotations
/// Packs       a lane whose eigenvalue is found stands still while others go on, so that it never depends on them
/// Source      tridiagonal_form.hpp, ql_step.hpp
/// Cost        about 2 N^2 rotations of N entries, and 4/3 N^3 multiply-adds; a third of Jacobi's
/// Tests       tests/unit/linalg/tridiagonal_ql_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/ql_step.hpp>
#include <softtissue/linalg/tridiagonal_form.hpp>

#include <Eigen/Core>

namespace softtissue {

/// A becomes the matrix of its eigenvectors; the eigenvalues.
template <RealLanes Scalar, int N>
    requires(N > 1)
Eigen::Matrix<Scalar, N, 1> diagonalise_by_ql(Eigen::Matrix<Scalar, N, N>& A) {
    constexpr int max_steps = 30;  // two an eigenvalue are usual
    TridiagonalForm<Scalar, N> T(A);
    for (int j = 0; j < N; ++j) {
        Eigen::Matrix<Scalar, N, 1> column;
        for (int i = 0; i < N; ++i) {
            column(i) = Scalar(i == j ? 1 : 0);
        }
        T.apply_reflections(column);
        A.col(j) = column;
    }
    const auto rotate = [&A](int i, const Scalar& cosine, const Scalar& sine) {
        for (int row = 0; row < N; ++row) {
            const Scalar q = A(row, i), next = A(row, i + 1);
            A(row, i) = cosine * q - sine * next;
            A(row, i + 1) = sine * q + cosine * next;
        }
    };
    for (int first = 0; first + 1 < N; ++first) {
        for (int step = 0; step < max_steps; ++step) {
            const auto is_active = is_coupling(T.below(first));
            if (!any_of(is_active)) {
                break;
            }
            ql_step(is_active, first, wilkinson_shift(T.diagonal, T.below, first), T.diagonal, T.below, rotate);
        }
    }
    for (int i = 0; i < N; ++i) {
        T.diagonal(i) = T.original(T.diagonal(i));
    }
    return T.diagonal;
}

}  // namespace softtissue
