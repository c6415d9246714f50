// SPDX-License-Identifier: MIT
#include <softtissue/linalg/tridiagonal_ql.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

template <class Scalar, int N>
using Square = Eigen::Matrix<Scalar, N, N>;

/// |A - Q diag(values) Q^T| and |Q^T Q - I|, the larger.
template <class S, int N>
S decomposition_error(const Square<S, N>& A, const Square<S, N>& Q, const Eigen::Matrix<S, N, 1>& values) {
    S error(0);
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            S rebuilt(0), gram(0);
            for (int k = 0; k < N; ++k) {
                rebuilt += Q(i, k) * values(k) * Q(j, k);
                gram += Q(k, i) * Q(k, j);
            }
            error = std::max({error, std::abs(rebuilt - A(i, j)), std::abs(gram - S(i == j ? 1 : 0))});
        }
    }
    return error;
}

template <class S, int N>
Square<S, N> random_symmetric(RandomGenerator& random) {
    Square<S, N> A;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            A(i, j) = A(j, i) = S(random.uniform(-1, 1));
        }
    }
    return A;
}

/// Matrices that end early, late, or in the middle: blocks, repeated eigenvalues, graded, rank one, zero, tiny entries.
template <class S, int N>
std::vector<Square<S, N>> hard_matrices(RandomGenerator& random) {
    std::vector<Square<S, N>> list{Square<S, N>::Zero(), Square<S, N>::Identity(), Square<S, N>::Ones()};
    for (int sample = 0; sample < 20; ++sample) {
        const Square<S, N> A = random_symmetric<S, N>(random);
        list.push_back(A);
        Square<S, N> blocks = A, graded = A, nearly_diagonal = A, tridiagonal = A;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) {
                blocks(i, j) *= S((i < N / 2) == (j < N / 2) ? 1 : 0);
                graded(i, j) *= std::pow(S(0.05), S(i + j));
                nearly_diagonal(i, j) *= i == j ? S(1) : std::numeric_limits<S>::epsilon();
                tridiagonal(i, j) *= S(std::abs(i - j) < 2 ? 1 : 0);
            }
        }
        list.insert(list.end(), {blocks, graded, nearly_diagonal, tridiagonal});
        Eigen::Matrix<S, N, 1> v = A.col(0);
        v /= std::sqrt(v.squaredNorm());
        list.push_back(v * v.transpose());
        list.push_back(Square<S, N>::Identity() - S(2) * v * v.transpose());  // eigenvalues -1, 1, ..., 1
        list.push_back(A * std::numeric_limits<S>::min());
    }
    return list;
}

template <class S, int N>
void check_all() {
    RandomGenerator random{std::uint64_t(N)};
    const S tolerance = S(8 * N) * std::numeric_limits<S>::epsilon();
    for (const Square<S, N>& A : hard_matrices<S, N>(random)) {
        CAPTURE(A);
        Square<S, N> Q = A;
        const Eigen::Matrix<S, N, 1> values = diagonalise_by_ql(Q);
        CHECK(decomposition_error(A, Q, values) <= tolerance);
    }
}

}  // namespace

TEST_CASE_TEMPLATE("matrices of every kind are decomposed", S, float, double) {
    check_all<S, 2>();
    check_all<S, 9>();
    check_all<S, 12>();
}

TEST_CASE_TEMPLATE("a lane of a pack is what it is alone among others", S, float, double) {
    constexpr int N = 9, width = natural_lanes < S >> 1 ? natural_lanes<S> : 4;
    using Lanes = Pack<S, width>;
    RandomGenerator random(3);
    std::vector<Square<S, N>> list = hard_matrices<S, N>(random);
    for (size_t first = 0; first + size_t(width) <= list.size(); first += size_t(width)) {
        const Square<Lanes, N> packed = packed_matrix<width>([&](int i) { return list[first + size_t(i)]; });
        Square<Lanes, N> Q = packed;
        const Eigen::Matrix<Lanes, N, 1> values = diagonalise_by_ql(Q);
        for (int i = 0; i < width; ++i) {
            const Square<S, N>& A = list[first + size_t(i)];
            CAPTURE(A);
            CHECK(decomposition_error(A, lane(Q, i), lane(values, i)) <= S(8 * N) * std::numeric_limits<S>::epsilon());
            Square<Lanes, N> alone = packed_matrix<width>([&](int) { return A; });
            const Eigen::Matrix<Lanes, N, 1> alone_values = diagonalise_by_ql(alone);
            CHECK(lane(values, i) == lane(alone_values, i));
            CHECK(lane(Q, i) == lane(alone, i));
        }
    }
}

TEST_CASE_TEMPLATE("only the lower triangle is read, and what is not finite ends", S, float, double) {
    RandomGenerator random(4);
    const S nan = std::numeric_limits<S>::quiet_NaN();
    const Square<S, 9> A = random_symmetric<S, 9>(random);
    Square<S, 9> lower = A, Q = A;
    for (int j = 1; j < 9; ++j) {
        lower.col(j).head(j).setConstant(nan);
    }
    const Eigen::Matrix<S, 9, 1> values = diagonalise_by_ql(Q);
    CHECK(diagonalise_by_ql(lower) == values);
    CHECK(lower == Q);
    Square<S, 9> broken = A;
    broken(5, 3) = broken(3, 5) = nan;
    CHECK_FALSE(diagonalise_by_ql(broken).allFinite());
}
