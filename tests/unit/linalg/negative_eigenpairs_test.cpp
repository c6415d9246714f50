// SPDX-License-Identifier: MIT
#include <softtissue/linalg/negative_eigenpairs.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// The error of A v = value v, v^T v = 1 and v^T w = 0 for all pairs below zero, and how far what they leave of A reaches below zero.
template <class S, int N>
S error_below_zero(const Square<S, N>& A, const Eigenpairs<S, N>& pairs) {
    S error(0);
    Square<S, N> rest = A;
    for (int k = 0; k < pairs.count; ++k) {
        if (!(pairs.values(k) < S(0))) {
            continue;
        }
        const Eigen::Matrix<S, N, 1> v = pairs.vectors.col(k);
        for (int i = 0; i < N; ++i) {
            S residual = -pairs.values(k) * v(i);
            for (int j = 0; j < N; ++j) {
                residual += A(i, j) * v(j);
                rest(i, j) -= pairs.values(k) * v(i) * v(j);
            }
            error = std::max(error, std::abs(residual));
        }
        for (int l = 0; l <= k; ++l) {
            if (pairs.values(l) < S(0)) {
                error = std::max(error, std::abs(v.dot(pairs.vectors.col(l)) - S(k == l ? 1 : 0)));
            }
        }
    }
    return std::max(error, -symmetric_eigen(rest).values.minCoeff());
}

template <class S, int N>
void check_all() {
    RandomGenerator random{std::uint64_t(N)};
    const S tolerance = S(16 * N) * std::numeric_limits<S>::epsilon();
    for (const Square<S, N>& A : hard_matrices<S, N>(random)) {
        CAPTURE(A);
        CHECK(error_below_zero<S, N>(A, negative_eigenpairs(A)) <= tolerance);
    }
}

}  // namespace

TEST_CASE_TEMPLATE("all that is negative is found, of matrices of every kind", S, float, double) {
    check_all<S, 2>();
    check_all<S, 3>();
    check_all<S, 9>();
    check_all<S, 12>();
}

TEST_CASE_TEMPLATE("eigenvalues that are equal but for one or two", S, float, double) {
    constexpr int N = 12;
    RandomGenerator random(6);
    for (int trial = 0; trial < 1000; ++trial) {
        Square<S, N> A = -Square<S, N>::Identity();
        for (int k = 0; k <= trial % 2; ++k) {
            const auto v = random_normal<Eigen::Matrix<S, N, 1>>(random).normalized().eval();
            A += v * v.transpose() * S(1 + trial / 2 % 2);
        }
        CAPTURE(A);
        CHECK(error_below_zero<S, N>(A, negative_eigenpairs(A)) <= S(16 * N) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("no more than is asked for", S, float, double) {
    RandomGenerator random(4);
    for (int count = 0; count <= 9; ++count) {
        Square<S, 9> Q = random_symmetric<S, 9>(random), values = Square<S, 9>::Zero();
        diagonalise_by_ql(Q);
        for (int i = 0; i < 9; ++i) {
            values(i, i) = S(i < count ? -1 - i : 10 + i);
        }
        const Square<S, 9> A = turned<S, 9>(Q, values);
        CAPTURE(A);
        const Eigenpairs<S, 9> pairs = negative_eigenpairs(A);
        CHECK(pairs.count == count);
        CHECK(error_below_zero<S, 9>(A, pairs) <= S(20 * 72) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("a lane of a pack is what it is alone among others", S, float, double) {
    constexpr int N = 9, width = natural_lanes < S >> 1 ? natural_lanes<S> : 4;
    using Lanes = Pack<S, width>;
    RandomGenerator random(3);
    const std::vector<Square<S, N>> list = hard_matrices<S, N>(random);
    for (std::size_t first = 0; first + std::size_t(width) <= list.size(); first += std::size_t(width)) {
        const Eigenpairs<Lanes, N> packed = negative_eigenpairs(
            packed_matrix<width>([&](int i) -> const Square<S, N>& { return list[first + std::size_t(i)]; }));
        for (int i = 0; i < width; ++i) {
            const Square<S, N>& A = list[first + std::size_t(i)];
            CAPTURE(A);
            const Eigenpairs<S, N> own{packed.count, lane(packed.values, i), lane(packed.vectors, i)};
            CHECK(error_below_zero<S, N>(A, own) <= S(16 * N) * std::numeric_limits<S>::epsilon());
            const Eigenpairs<Lanes, N> alone = negative_eigenpairs(packed_matrix<width>([&](int) { return A; }));
            CHECK(alone.count <= packed.count);
            for (int k = 0; k < alone.count; ++k) {
                CHECK(lane(packed.values(k), i) == lane(alone.values(k), i));
                for (int row = 0; row < N; ++row) {
                    CHECK(lane(packed.vectors(row, k), i) == lane(alone.vectors(row, k), i));
                }
            }
        }
    }
}

TEST_CASE_TEMPLATE("sizes at the ends of the range of numbers", S, float, double) {
    RandomGenerator random(5);
    const Square<S, 9> A = random_symmetric<S, 9>(random);
    const S factor = std::numeric_limits<S>::max() / S(16);
    const Eigenpairs<S, 9> pairs = negative_eigenpairs(A), large = negative_eigenpairs(Square<S, 9>(factor * A));
    REQUIRE(large.count == pairs.count);
    for (int k = 0; k < pairs.count; ++k) {
        CHECK(std::abs(large.values(k) / factor - pairs.values(k)) <= S(72) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("what is not finite ends") {
    RandomGenerator random(6);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Square<double, 9> A = random_symmetric<double, 9>(random);
        A(5, 3) = A(3, 5) = bad;
        CHECK(negative_eigenpairs(A).count <= 9);
    }
}

TEST_CASE_TEMPLATE("a lane that has fewer has zeros, also where its eigenvalues are no numbers", S, float, double) {
    constexpr int N = 9, width = natural_lanes < S >> 1 ? natural_lanes<S> : 4;
    const Square<S, N> negative = -Square<S, N>::Identity();
    const Square<S, N> large = Square<S, N>::Constant(std::numeric_limits<S>::max() / S(2)) +
                               Square<S, N>(std::numeric_limits<S>::max() / S(4) * Square<S, N>::Identity());
    const auto pairs =
        negative_eigenpairs(packed_matrix<width>([&](int i) { return Square<S, N>(i == 0 ? large : negative); }));
    CHECK(pairs.count == N);
    for (int k = 0; k < N; ++k) {
        CHECK(lane(pairs.values(k), 0) == S(0));
        CHECK(lane(pairs.values(k), 1) == S(-1));
    }
}
