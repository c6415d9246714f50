// SPDX-License-Identifier: MIT
/// @file
/// The Hessian of an isotropic energy from its eigensystem, with negative eigenvalues filtered in closed form.
///
/// What        9x9 Hessian of psi(s_0, s_1, s_2) at F = U diag(s) V^T from the 3x3 second derivatives by the signed
///             singular values and the eigenvalues of the three twist and three flip modes
/// Equation    A_ij = d2psi / ds_i ds_j;  p_i = dpsi / ds_i;
///             twist_k = (p_i + p_j) / (s_i + s_j) on (u_i v_j^T - u_j v_i^T) / sqrt 2,
///             flip_k  = (p_i - p_j) / (s_i - s_j) on (u_i v_j^T + u_j v_i^T) / sqrt 2,  {i, j, k} = {0, 1, 2}
/// Shapes      A: 3x3 symmetric.  twist, flip: 3.  Result: 9x9 on column-major vec(F), exactly symmetric.
/// Units       Pa.  The material gives twist and flip simplified, so that no difference of singular values is divided by.
/// Source      Smith, de Goes, Kim 2019, "Analytic Eigensystems for Isotropic Distortion Energies", sec. 4
/// Cost        about 500 multiply-adds; one 3x3 eigen-decomposition where A is indefinite and filtered
/// Tests       tests/unit/material/isotropic_hessian_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/svd3.hpp>

namespace softtissue {

/// Second derivatives of an isotropic energy in the frame of the singular vectors; entry k of twist and flip
/// belongs to the plane of the two other axes.
template <FieldScalar Scalar>
struct IsotropicSpectrum {
    Matrix3<Scalar> A;
    Vector3<Scalar> twist;
    Vector3<Scalar> flip;
};

/// The spectrum with every negative eigenvalue filtered.
template <RealLanes Scalar>
IsotropicSpectrum<Scalar> filtered(const IsotropicSpectrum<Scalar>& spectrum, PsdFilter filter) {
    IsotropicSpectrum<Scalar> result;
    result.A = filtered(spectrum.A, filter);
    for (int k = 0; k < 3; ++k) {
        result.twist(k) = filtered_eigenvalue(spectrum.twist(k), filter);
        result.flip(k) = filtered_eigenvalue(spectrum.flip(k), filter);
    }
    return result;
}

/// The Hessian by F of the energy whose spectrum at the singular values of F is `spectrum`.
template <RealLanes Scalar>
Matrix9<Scalar> isotropic_hessian(const Svd3<Scalar>& svd, const IsotropicSpectrum<Scalar>& spectrum) {
    // In the frame of the singular vectors entry (a, b) couples with itself (K) and with (b, a) (L), and the
    // diagonal entries couple among each other (A). The frame is turned back by 3x3 blocks: U M U^T.
    const Matrix3<Scalar>& A = spectrum.A;
    Matrix3<Scalar> K = A;
    Matrix3<Scalar> L = Matrix3<Scalar>::Zero();
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        K(i, j) = K(j, i) = (spectrum.flip(k) + spectrum.twist(k)) / Scalar(2);
        L(i, j) = L(j, i) = (spectrum.flip(k) - spectrum.twist(k)) / Scalar(2);
    }
    Matrix9<Scalar> H;
    for (int l = 0; l < 3; ++l) {
        for (int j = l; j < 3; ++j) {
            Matrix3<Scalar> M;
            for (int a = 0; a < 3; ++a) {
                for (int c = 0; c < 3; ++c) {
                    M(a, c) = svd.V(j, a) * svd.V(l, c) * A(a, c) + svd.V(j, c) * svd.V(l, a) * L(a, c);
                }
                M(a, a) = Scalar(0);
                for (int b = 0; b < 3; ++b) {
                    M(a, a) += svd.V(j, b) * svd.V(l, b) * K(a, b);
                }
            }
            H.template block<3, 3>(3 * j, 3 * l) = svd.U * M * svd.U.transpose();
        }
    }
    for (int column = 1; column < 9; ++column) {
        for (int row = 0; row < column; ++row) {
            H(row, column) = H(column, row);
        }
    }
    return H;
}

}  // namespace softtissue
