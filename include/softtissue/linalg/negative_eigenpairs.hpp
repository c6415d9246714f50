// SPDX-License-Identifier: MIT
/// @file
/// The negative eigenvalues of a small symmetric matrix and their eigenvectors.
///
/// What        values and vectors of all negative eigenvalues at least: in the first `count` columns; a lane that has fewer has values there
///             that are zero, or not negative but within rounding
/// Equation    Laguerre's method gives the smallest eigenvalue of the tridiagonal form, plane rotations take it off, and so on with
///             the rest until the minors of that say that it is positive definite
/// Shapes      H: N x N, N > 1 up to about a dozen; only the lower triangle is read
/// Valid       every finite H. Where H is not finite, nothing is said.
///             Packs: no lane depends on the others.
/// Accuracy    a few epsilon |H| in H V = V diag(values) and V^T V = I, ten times as much of graded matrices with many small eigenvalues
/// Source      tridiagonal_form.hpp, tridiagonal_laguerre.hpp, tridiagonal_deflation.hpp; QL steps where the last one cannot
/// Cost        2/3 N^3 multiply-adds; an eigenvalue four steps of Laguerre's method, two passes of N quotients, and reflections of its vector:
///             three of nine a third of what all take by tridiagonal_ql.hpp
/// Tests       tests/unit/linalg/negative_eigenpairs_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/ql_step.hpp>
#include <softtissue/linalg/symmetric_eigen.hpp>
#include <softtissue/linalg/tridiagonal_deflation.hpp>
#include <softtissue/linalg/tridiagonal_form.hpp>
#include <softtissue/linalg/tridiagonal_laguerre.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>

namespace softtissue {

template <RealLanes Scalar, int N>
struct Eigenpairs {
    int count;
    Eigen::Matrix<Scalar, N, 1> values;
    Eigen::Matrix<Scalar, N, N> vectors;
};

namespace detail {

/// The rotations of one QL step.
template <class Scalar, int N>
struct QlRotations {
    int first;
    Eigen::Matrix<Scalar, N, 1> cosines, sines;

    /// v becomes G v.
    void apply(Eigen::Matrix<Scalar, N, 1>& v) const {
        for (int i = first; i + 1 < N; ++i) {
            const Scalar x = v(i), next = v(i + 1);
            v(i) = cosines(i) * x + sines(i) * next;
            v(i + 1) = cosines(i) * next - sines(i) * x;
        }
    }
};

}  // namespace detail

template <RealLanes Scalar, int N>
    requires(N > 1)
Eigenpairs<Scalar, N> negative_eigenpairs(const Eigen::Matrix<Scalar, N, N>& lower) {
    if constexpr (N == 3) {  // all of them cost less
        const SymmetricEigen<Scalar, N> eigen = symmetric_eigen(lower);
        return {N, eigen.values, eigen.vectors};
    } else {
        using Real = RealOf<Scalar>;
        const Scalar zero(0);
        Eigenpairs<Scalar, N> result;
        TridiagonalForm<Scalar, N> T(lower);
        constexpr std::size_t max_ql_steps = std::size_t(3 * N);  // next to none is usual
        std::array<detail::QlRotations<Scalar, N>, max_ql_steps + std::size_t(N)> steps;
        std::size_t num_steps = 0;
        const Scalar smallest(Real(-2) * std::numeric_limits<Real>::epsilon());
        Scalar eigenvalue = eigenvalue_bound(T.diagonal, T.below);
        int first = 0;
        for (; first < N; ++first) {
            const auto is_wanted = !has_only_eigenvalues_above(smallest, first, T.diagonal, T.below);
            if (!any_of(is_wanted)) {
                break;
            }
            if (first == N - 1) {
                result.values(first) = select(is_wanted, T.original(T.diagonal(first)), zero);
                continue;
            }
            eigenvalue = smallest_eigenvalue(eigenvalue, is_wanted, first, T.diagonal, T.below);
            auto& rotations = steps[num_steps++];
            rotations.first = first;
            const auto is_done =
                deflate(is_wanted, eigenvalue, first, T.diagonal, T.below, rotations.cosines, rotations.sines);
            auto is_active = is_wanted & !is_done & is_coupling(T.below(first));
            Scalar shift = eigenvalue;
            while (any_of(is_active) && num_steps < max_ql_steps) {
                auto& step = steps[num_steps++];
                step.first = first;
                ql_step(is_active, first, shift, T.diagonal, T.below,
                        [&step](int i, const Scalar& cosine, const Scalar& sine) {
                            step.cosines(i) = cosine;
                            step.sines(i) = sine;
                        });
                is_active = is_active & is_coupling(T.below(first));
                shift = wilkinson_shift(T.diagonal, T.below, first);
            }
            result.values(first) = select(is_wanted, T.original(T.diagonal(first)), zero);
        }
        result.count = first;
        for (int k = 0; k < result.count; ++k) {
            Eigen::Matrix<Scalar, N, 1> v;
            for (int i = 0; i < N; ++i) {
                v(i) = Scalar(i == k ? 1 : 0);
            }
            for (std::size_t step = num_steps; step-- > 0;) {
                steps[step].apply(v);
            }
            T.apply_reflections(v);
            result.vectors.col(k) = v;
        }
        return result;
    }
}

}  // namespace softtissue
