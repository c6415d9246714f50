// SPDX-License-Identifier: MIT
/// @file
/// Makes a small symmetric matrix positive semi-definite by treating its negative eigenvalues.
///
/// What        PsdFilter {none, clamp, absolute}; filtered(H, filter) by a numeric eigen-decomposition
/// Equation    H = sum_k l_k v_k v_k^T  ->  sum_k f(l_k) v_k v_k^T;  clamp: f(l) = max(l, 0), absolute: f(l) = |l|
/// Shapes      H: N x N, N > 1 fixed.  Only the lower triangle is read; the result is exactly symmetric.
/// Valid       every finite H.  A matrix that holds NaN or infinity stays non-finite, nothing is thrown.
///             Packs: no lane depends on the others.
/// Source      clamp: Teran et al. 2005; absolute: Chen et al. 2024, "Stabler Neo-Hookean Simulation"
/// Cost        one Cholesky factorisation where H is positive definite, else one eigen-decomposition
/// Tests       tests/unit/linalg/psd_filter_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/symmetric_eigen.hpp>

#include <Eigen/Core>

namespace softtissue {

/// What happens to the negative eigenvalues of a Hessian.
enum class PsdFilter {
    none,      ///< kept: the exact Hessian
    clamp,     ///< set to zero
    absolute,  ///< replaced by their absolute value
};

/// The eigenvalue that `filter` puts in the place of `eigenvalue`.
template <FieldScalar Scalar>
Scalar filtered_eigenvalue(const Scalar& eigenvalue, PsdFilter filter) {
    if (filter == PsdFilter::none) {
        return eigenvalue;
    }
    return select(eigenvalue < Scalar(0), filter == PsdFilter::clamp ? Scalar(0) : Scalar(-eigenvalue), eigenvalue);
}

namespace detail {

/// Whether the Cholesky factorisation of H exists (to rounding); plain loops keep it cheap to run and to compile.
template <RealLanes Scalar, int N>
auto is_positive_definite(Eigen::Matrix<Scalar, N, N> H) {
    auto is_definite = H(0, 0) > Scalar(0);
    for (int k = 0; k < N; ++k) {
        const auto is_positive = H(k, k) > Scalar(0);
        is_definite = is_definite & is_positive;
        if (!any_of(is_definite)) {
            break;
        }
        const Scalar inverse = reciprocal(H(k, k));
        for (int j = k + 1; j < N; ++j) {
            const Scalar factor = H(j, k) * inverse;
            for (int i = j; i < N; ++i) {
                H(i, j) -= factor * H(i, k);
            }
        }
    }
    return is_definite;
}

}  // namespace detail

/// H with its negative eigenvalues filtered; H itself where there are none (or `filter` is none).
template <RealLanes Scalar, int N>
    requires(N > 1)
Eigen::Matrix<Scalar, N, N> filtered(const Eigen::Matrix<Scalar, N, N>& H, PsdFilter filter) {
    using Matrix = Eigen::Matrix<Scalar, N, N>;
    Matrix result;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            result(i, j) = result(j, i) = H(i, j);
        }
    }
    if (filter == PsdFilter::none) {
        return result;
    }
    const auto is_definite = detail::is_positive_definite(H);
    if (all_of(is_definite)) {
        return result;
    }
    const SymmetricEigen<Scalar, N> eigen = symmetric_eigen(H);
    // Only the negative part is touched, so what is already positive keeps its digits.
    for (int k = 0; k < N; ++k) {
        const Scalar change =
            select(is_definite, Scalar(0), Scalar(filtered_eigenvalue(eigen.values(k), filter) - eigen.values(k)));
        if (all_of(change == Scalar(0))) {
            continue;
        }
        for (int j = 0; j < N; ++j) {
            const Scalar v = change * eigen.vectors(j, k);
            for (int i = j; i < N; ++i) {
                result(i, j) += v * eigen.vectors(i, k);
                result(j, i) = result(i, j);
            }
        }
    }
    return result;
}

}  // namespace softtissue
