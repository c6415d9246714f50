// SPDX-License-Identifier: MIT
/// @file
/// The determinant of a 3x3 matrix and its first two derivatives.
///
/// What        J = det F, cofactor(F) = dJ/dF, and d2J/dF2
/// Equation    cof F = [f1 x f2, f2 x f0, f0 x f1] with the columns f_j of F; the blocks of d2J/dF2 are +-[f_k]x
/// Shapes      F, cof F: 3x3.  d2J/dF2: 9x9 on column-major vec(F), symmetric, indefinite.
/// Valid       every F and every FieldScalar; no division
/// Tests       tests/unit/linalg/cofactor_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

namespace softtissue {

/// dJ/dF, which is J F^-T where F is invertible.
template <FieldScalar Scalar>
[[gnu::always_inline]] inline Matrix3<Scalar> cofactor(const Matrix3<Scalar>& F) {
    Matrix3<Scalar> cof;
    for (int j = 0; j < 3; ++j) {
        const int k = (j + 1) % 3;
        const int l = (j + 2) % 3;
        for (int i = 0; i < 3; ++i) {
            const int m = (i + 1) % 3;
            const int n = (i + 2) % 3;
            cof(i, j) = F(m, k) * F(n, l) - F(n, k) * F(m, l);
        }
    }
    return cof;
}

/// det F from its cofactor matrix.
template <FieldScalar Scalar>
Scalar determinant(const Matrix3<Scalar>& F, const Matrix3<Scalar>& cof) {
    return F(0, 0) * cof(0, 0) + F(1, 0) * cof(1, 0) + F(2, 0) * cof(2, 0);
}

/// det F.
template <FieldScalar Scalar>
Scalar determinant(const Matrix3<Scalar>& F) {
    return F(0, 0) * (F(1, 1) * F(2, 2) - F(2, 1) * F(1, 2)) - F(1, 0) * (F(0, 1) * F(2, 2) - F(2, 1) * F(0, 2)) +
           F(2, 0) * (F(0, 1) * F(1, 2) - F(1, 1) * F(0, 2));
}

/// H += factor d2J/dF2.
template <FieldScalar Scalar>
void add_determinant_hessian(const Matrix3<Scalar>& F, const Scalar& factor, Matrix9<Scalar>& H) {
    // d2J / dF_ij dF_kl = e_ikm e_jln F_mn: for i != k and j != l the one remaining entry of F, with a sign.
    for (int j = 0; j < 3; ++j) {
        for (int step_l = 1; step_l < 3; ++step_l) {
            const int l = (j + step_l) % 3;
            const int n = (j + 3 - step_l) % 3;
            for (int i = 0; i < 3; ++i) {
                const int next = (i + 1) % 3;
                const int previous = (i + 2) % 3;
                const Scalar forward = factor * F(previous, n);
                const Scalar backward = factor * F(next, n);
                H(i + 3 * j, next + 3 * l) += step_l == 1 ? forward : Scalar(-forward);
                H(i + 3 * j, previous + 3 * l) -= step_l == 1 ? backward : Scalar(-backward);
            }
        }
    }
}

}  // namespace softtissue
