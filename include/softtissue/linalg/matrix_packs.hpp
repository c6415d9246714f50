// SPDX-License-Identifier: MIT
/// @file
/// 3x3 matrices of an array in the lanes of one matrix of packs, and back.
///
/// What        load_matrices<N>(): matrices `first` to `first + N - 1`; store_matrices<N>() writes them;
///             side_by_side<count>(): those of several packs in one of as many registers
/// Shapes      3 x 3n: matrix c in the columns 3c to 3c + 2. Lanes beyond the last matrix repeat it and are not written.
/// Cost        nine_number_lanes.hpp
/// Tests       tests/unit/linalg/matrix_packs_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/nine_number_lanes.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace softtissue {

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

/// The lanes of part(0), then those of part(1), ...; each part a Matrix3 of packs that fill a register.
template <int count, class F>
auto side_by_side(const F& part) {
    using Part = std::remove_cvref_t<decltype(part(0))>;
    if constexpr (count == 1) {
        return Part(part(0));
    } else {
        using Lanes = typename Part::Scalar;
        Matrix3<Pack<RealOf<Lanes>, count * num_lanes<Lanes>>> result;
        for (int k = 0; k < count; ++k) {
            const Part matrices = part(k);
            for (int i = 0; i < 9; ++i) {
                result.data()[i].lanes[std::size_t(k)] = matrices.data()[i];
            }
        }
        return result;
    }
}

}  // namespace softtissue
