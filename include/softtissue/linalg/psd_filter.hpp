// SPDX-License-Identifier: MIT
/// @file
/// Makes a small symmetric matrix positive semi-definite by treating its negative eigenvalues.
///
/// What        PsdFilter {none, clamp, absolute}; filtered(H, filter) by numeric eigenpairs
/// Equation    H = sum_k l_k v_k v_k^T  ->  sum_k f(l_k) v_k v_k^T;  clamp: f(l) = max(l, 0), absolute: f(l) = |l|
/// Shapes      H: N x N, N > 1 fixed.  Only the lower triangle is read; the result is exactly symmetric.
/// Valid       every finite H.  A matrix that holds NaN or infinity stays non-finite, nothing is thrown.
///             Packs: no lane depends on the others.
/// Source      clamp: Teran et al. 2005; absolute: Chen et al. 2024, "Stabler Neo-Hookean Simulation"
/// Cost        one Cholesky factorisation where H is positive definite, else the eigenpairs below zero (negative_eigenpairs.hpp)
/// Tests       tests/unit/linalg/psd_filter_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/negative_eigenpairs.hpp>

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
        const Scalar inverse = Scalar(1) / H(k, k);
        for (int j = k + 1; j < N; ++j) {
            const Scalar factor = H(j, k) * inverse;
            for (int i = j; i < N; ++i) {
                H(i, j) -= factor * H(i, k);
            }
        }
    }
    return is_definite;
}

/// Filters H, of which the lower triangle counts, where `is_changing`. Only the negative part is touched, so that what is
/// already positive keeps its digits.
template <RealLanes Scalar, int N, class Mask>
void filter_lower(const Mask& is_changing, PsdFilter filter, Eigen::Matrix<Scalar, N, N>& H) {
    const Scalar zero(0);
    const Eigenpairs<Scalar, N> eigen = negative_eigenpairs(H);
    for (int k = 0; k < eigen.count; ++k) {
        const auto is_added = is_changing & (eigen.values(k) < zero);
        const Scalar value = select(is_added, eigen.values(k), zero);
        const Scalar change = filtered_eigenvalue(value, filter) - value;
        Eigen::Matrix<Scalar, N, 1> v;
        for (int i = 0; i < N; ++i) {
            v(i) = select(is_added, eigen.vectors(i, k), zero);  // zero times what is not finite is no zero
        }
        for (int j = 0; j < N; ++j) {
            const Scalar factor = change * v(j);
            for (int i = j; i < N; ++i) {
                H(i, j) += factor * v(i);
            }
        }
    }
}

}  // namespace detail

/// H with its negative eigenvalues filtered; H itself where there are none (or `filter` is none).
template <RealLanes Scalar, int N>
    requires(N > 1)
Eigen::Matrix<Scalar, N, N> filtered(const Eigen::Matrix<Scalar, N, N>& H, PsdFilter filter) {
    Eigen::Matrix<Scalar, N, N> result = H;
    if (filter != PsdFilter::none) {
        const auto is_definite = detail::is_positive_definite(H);
        if (!all_of(is_definite)) {
            detail::filter_lower(!is_definite, filter, result);
        }
    }
    for (int j = 0; j < N; ++j) {
        for (int i = j + 1; i < N; ++i) {
            result(j, i) = result(i, j);
        }
    }
    return result;
}

}  // namespace softtissue
