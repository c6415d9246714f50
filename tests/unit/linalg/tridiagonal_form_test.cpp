// SPDX-License-Identifier: MIT
#include <softtissue/linalg/tridiagonal_form.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/core/pack.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// The reflections as a matrix.
template <class S, int N>
Square<S, N> dense_reflections(const TridiagonalForm<S, N>& T) {
    Square<S, N> Q;
    for (int j = 0; j < N; ++j) {
        Eigen::Matrix<S, N, 1> column = Eigen::Matrix<S, N, 1>::Unit(j);
        T.apply_reflections(column);
        Q.col(j) = column;
    }
    return Q;
}

template <class S, int N>
void check_all() {
    RandomGenerator random(11);
    const S tolerance = S(8 * N) * std::numeric_limits<S>::epsilon();
    for (const Square<S, N>& A : hard_matrices<S, N>(random)) {
        CAPTURE(A);
        const TridiagonalForm<S, N> T(A);
        CHECK(T.below(N - 1) == S(0));
        const Square<S, N> Q = dense_reflections(T);
        const Square<S, N> rebuilt = turned<S, N>(Q, tridiagonal<S, N>(T.diagonal, T.below));
        const S size = A.cwiseAbs().maxCoeff();
        S error(0);
        for (int k = 0; k < N * N; ++k) {
            error = std::max(error, std::abs(T.original(rebuilt.data()[k]) - A.data()[k]));
        }
        CHECK(error <= tolerance * size);
        CHECK((turned<S, N>(Q, Square<S, N>::Identity()) - Square<S, N>::Identity()).cwiseAbs().maxCoeff() <=
              tolerance);
    }
}

}  // namespace

TEST_CASE_TEMPLATE("a matrix is its tridiagonal form between the reflections", S, float, double) {
    check_all<S, 2>();
    check_all<S, 3>();
    check_all<S, 9>();
}

TEST_CASE_TEMPLATE("matrices of any size give the same form", S, float, double) {
    RandomGenerator random(12);
    const Square<S, 5> A = random_symmetric<S, 5>(random);
    const TridiagonalForm<S, 5> T(A);
    for (const S factor : {std::numeric_limits<S>::max() / S(2), S(64) * std::numeric_limits<S>::min()}) {
        const TridiagonalForm<S, 5> other(Square<S, 5>(factor * A));
        CHECK((other.diagonal - T.diagonal).cwiseAbs().maxCoeff() <= S(8) * std::numeric_limits<S>::epsilon());
        CHECK((other.below - T.below).cwiseAbs().maxCoeff() <= S(8) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("a lane of a pack depends on no other, and only the lower triangle is read", S, float, double) {
    constexpr int N = 6, width = natural_lanes < S >> 1 ? natural_lanes<S> : 4;
    using Lanes = Pack<S, width>;
    RandomGenerator random(13);
    std::vector<Square<S, N>> list = hard_matrices<S, N>(random);
    for (Square<S, N>& A : list) {
        A(0, N - 1) = std::numeric_limits<S>::quiet_NaN();
    }
    const TridiagonalForm<Lanes, N> together(packed_matrix<width>([&](int i) { return list[std::size_t(i)]; }));
    for (int i = 0; i < width; ++i) {
        const TridiagonalForm<Lanes, N> alone(packed_matrix<width>([&](int) { return list[std::size_t(i)]; }));
        CHECK(lane(together.diagonal, i) == lane(alone.diagonal, i));
        CHECK(lane(together.below, i) == lane(alone.below, i));
        CHECK(lane(together.diagonal, i).allFinite());
    }
}
