// SPDX-License-Identifier: MIT
/// @file
/// The nearest rotation of many 3x3 matrices.
///
/// What        the local step of projective methods: R_c = argmin |F_c - R|, det R_c = +1, for a whole mesh; from a start of its
///             own, or from the quaternions of a former fit, which is faster the less the matrices have turned
/// Shapes      gradients, rotations 3 x 3n: matrix c in the columns 3c to 3c + 2; they may be the same array.
///             quaternions 4 x n (w, x, y, z)
/// Valid       every finite F; see linalg/polar.hpp for where R is not unique
/// Packs       as many matrices at a time as a register has lanes; none depends on its neighbours
/// Source      Bouaziz et al. 2014; Komaritzan & Botsch 2018
/// Cost        rotation_start.hpp (not from a former fit), rotation_newton.hpp; a pack one of whose lanes is not reached from its
///             start is decomposed
/// Tests       tests/unit/linalg/rotation_fit_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/nine_number_lanes.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/linalg/rotation_newton.hpp>
#include <softtissue/linalg/rotation_start.hpp>

#include <algorithm>
#include <cstddef>

namespace softtissue {

/// A unit quaternion per matrix, 4 x n.
template <class Scalar>
using Quaternions = Eigen::Matrix<Scalar, 4, Eigen::Dynamic>;

namespace detail {

/// Matrices `first`, `first + 1`, ... in the lanes; those beyond the last repeat it.
template <int N, RealScalar S>
Matrix3<Pack<S, N>> load_matrices(const Matrix3X<S>& matrices, Index first) {
    S lanes[9][std::size_t(N)];
    const Index count = std::min(Index(N), matrices.cols() / 3 - first);
    const S* const columns = matrices.data() + 9 * first;
    if (count == N) {
        columns_to_lanes(columns, lanes);
    } else {
        S padded[9 * std::size_t(N)];
        for (Index i = 0; i < N; ++i) {
            std::copy_n(columns + 9 * std::min(i, count - 1), 9, padded + 9 * i);
        }
        columns_to_lanes(padded, lanes);
    }
    Matrix3<Pack<S, N>> result;
    for (int k = 0; k < 9; ++k) {
        result.data()[k] = Pack<S, N>::load(lanes[k]);
    }
    return result;
}

/// Writes what load_matrices() reads.
template <int N, RealScalar S>
void store_matrices(const Matrix3<Pack<S, N>>& packed, Index first, Matrix3X<S>& matrices) {
    S lanes[9][std::size_t(N)];
    for (int k = 0; k < 9; ++k) {
        packed.data()[k].store(lanes[k]);
    }
    const Index count = std::min(Index(N), matrices.cols() / 3 - first);
    S* const columns = matrices.data() + 9 * first;
    if (count == N) {
        lanes_to_columns(lanes, columns);
    } else {
        S padded[9 * std::size_t(N)];
        lanes_to_columns(lanes, padded);
        std::copy_n(padded, 9 * count, columns);
    }
}

/// From the quaternion q, where Newton's method gets there, else by decomposition; q becomes that of the result.
template <RealLanes Lanes>
Matrix3<Lanes> fit_rotation(const Matrix3<Lanes>& F, Quaternion<Lanes>& q) {
    const auto is_reached = refine_rotation(F, q);
    if (!all_of(is_reached)) {
        const Quaternion<Lanes> decomposed = quaternion_from_rotation_matrix(polar_rotation(F));
        for (int k = 0; k < 4; ++k) {
            q(k) = select(is_reached, q(k), decomposed(k));
        }
    }
    return rotation_matrix_from_quaternion(q);
}

template <RealScalar S>
Index num_matrices(const Matrix3X<S>& gradients) {
    require(gradients.cols() % 3 == 0, "rotation fit: ", gradients.cols(), " columns, expected three per matrix");
    return gradients.cols() / 3;
}

}  // namespace detail

/// Writes one rotation per matrix; allocates nothing. Same bits for every executor.
template <RealScalar S, Executor E = SequentialExecutor>
void fit_rotations_into(const Matrix3X<S>& gradients, Matrix3X<S>& rotations, const E& executor = {}) {
    constexpr int N = natural_lanes<S>;
    const Index count = detail::num_matrices(gradients);
    rotations.resize(3, gradients.cols());
    executor.for_each_range((count + N - 1) / N, [&](Index begin, Index end) {
        for (Index first = N * begin; first < N * end; first += N) {
            const Matrix3<Pack<S, N>> F = detail::load_matrices<N>(gradients, first);
            Quaternion<Pack<S, N>> q = rotation_start(F);
            detail::store_matrices<N>(detail::fit_rotation(F, q), first, rotations);
        }
    });
}

/// The same from the unit quaternions of a former fit, which become those of this one.
template <RealScalar S, Executor E = SequentialExecutor>
void fit_rotations_into(const Matrix3X<S>& gradients, Quaternions<S>& quaternions, Matrix3X<S>& rotations,
                        const E& executor = {}) {
    constexpr int N = natural_lanes<S>;
    const Index count = detail::num_matrices(gradients);
    require(quaternions.cols() == count, "rotation fit: ", quaternions.cols(), " quaternions, expected ", count);
    rotations.resize(3, gradients.cols());
    executor.for_each_range((count + N - 1) / N, [&](Index begin, Index end) {
        for (Index first = N * begin; first < N * end; first += N) {
            const Matrix3<Pack<S, N>> F = detail::load_matrices<N>(gradients, first);
            Quaternion<Pack<S, N>> q =
                packed_matrix<N>([&](int i) { return Quaternion<S>(quaternions.col(std::min(first + i, count - 1))); });
            detail::store_matrices<N>(detail::fit_rotation(F, q), first, rotations);
            for (int i = 0; i < N && first + i < count; ++i) {
                quaternions.col(first + i) = lane(q, i);
            }
        }
    });
}

}  // namespace softtissue
