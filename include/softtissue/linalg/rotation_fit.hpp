// SPDX-License-Identifier: MIT
/// @file
/// The nearest rotation of many 3x3 matrices.
///
/// What        the local step of projective methods: R_c = argmin |F_c - R|, det R_c = +1, for a whole mesh; from a start of its
///             own, or from the quaternions of a former fit, which is faster the less the matrices have turned
/// Shapes      gradients, rotations 3 x 3n: matrix c in the columns 3c to 3c + 2; they may be the same array.
///             quaternions n x 4 (w, x, y, z)
/// Valid       every finite F; see linalg/polar.hpp for where R is not unique
/// Packs       as many matrices at a time as three registers have lanes; none depends on its neighbours
/// Source      Bouaziz et al. 2014; Komaritzan & Botsch 2018
/// Cost        polar.hpp
/// Tests       tests/unit/linalg/rotation_fit_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/matrix_packs.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <algorithm>
#include <cstddef>

namespace softtissue {

/// A unit quaternion per matrix, n x 4: the w of all matrices together, then the x, ...
template <class Scalar>
using Quaternions = Eigen::Matrix<Scalar, Eigen::Dynamic, 4>;

/// Rows `first` to `first + N - 1` in the lanes; those beyond the last row repeat it.
template <int N, RealScalar S>
Quaternion<Pack<S, N>> load_quaternions(const Quaternions<S>& quaternions, Index first) {
    Quaternion<Pack<S, N>> result;
    for (int k = 0; k < 4; ++k) {
        const S* const numbers = quaternions.data() + k * quaternions.rows() + first;
        if (first + N <= quaternions.rows()) {
            result(k) = Pack<S, N>::load(numbers);
        } else {
            const Index last = quaternions.rows() - 1 - first;
            result(k) = Pack<S, N>::from_lanes([&](int i) { return numbers[std::min(Index(i), last)]; });
        }
    }
    return result;
}

/// Writes what load_quaternions() reads.
template <int N, RealScalar S>
void store_quaternions(const Quaternion<Pack<S, N>>& packed, Index first, Quaternions<S>& quaternions) {
    for (int k = 0; k < 4; ++k) {
        S* const numbers = quaternions.data() + k * quaternions.rows() + first;
        if (first + N <= quaternions.rows()) {
            packed(k).store(numbers);
        } else {
            for (int i = 0; first + i < quaternions.rows(); ++i) {
                numbers[i] = packed(k)[i];
            }
        }
    }
}

/// What a step of Newton's method computes waits for itself: three registers' worth keep the processor as busy as it gets.
template <RealScalar S>
inline constexpr int rotation_fit_registers = natural_lanes<S> > 1 ? 3 : 1;

namespace detail {

template <RealScalar S>
Index num_matrices(const Matrix3X<S>& gradients) {
    require(gradients.cols() % 3 == 0, "rotation fit: ", gradients.cols(), " columns, expected three per matrix");
    return gradients.cols() / 3;
}

}  // namespace detail

/// Writes one rotation per matrix; allocates nothing. Same bits for every executor.
template <RealScalar S, Executor E = SequentialExecutor>
void fit_rotations_into(const Matrix3X<S>& gradients, Matrix3X<S>& rotations, const E& executor = {}) {
    constexpr int N = rotation_fit_registers<S> * natural_lanes<S>;
    const Index count = detail::num_matrices(gradients);
    rotations.resize(3, gradients.cols());
    executor.for_each_range((count + N - 1) / N, [&](Index begin, Index end) {
        for (Index first = N * begin; first < N * end; first += N) {
            store_matrices<N>(polar_rotation(load_matrices<N>(gradients, first)), first, rotations);
        }
    });
}

/// The same from the unit quaternions of a former fit, which become those of this one.
template <RealScalar S, Executor E = SequentialExecutor>
void fit_rotations_into(const Matrix3X<S>& gradients, Quaternions<S>& quaternions, Matrix3X<S>& rotations,
                        const E& executor = {}) {
    constexpr int N = rotation_fit_registers<S> * natural_lanes<S>;
    const Index count = detail::num_matrices(gradients);
    require(quaternions.rows() == count, "rotation fit: ", quaternions.rows(), " quaternions, expected ", count);
    rotations.resize(3, gradients.cols());
    executor.for_each_range((count + N - 1) / N, [&](Index begin, Index end) {
        for (Index first = N * begin; first < N * end; first += N) {
            const Matrix3<Pack<S, N>> F = load_matrices<N>(gradients, first);
            Quaternion<Pack<S, N>> q = load_quaternions<N>(quaternions, first);
            store_matrices<N>(polar_rotation(F, q), first, rotations);
            store_quaternions<N>(q, first, quaternions);
        }
    });
}

}  // namespace softtissue
