// SPDX-License-Identifier: MIT
#include <softtissue/linalg/tridiagonal_ql.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/core/pack.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

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

TEST_CASE_TEMPLATE("subnormal and huge matrices are decomposed as those of the size of one", S, float, double) {
    constexpr int N = 9;
    using Limits = std::numeric_limits<S>;
    RandomGenerator random(5);
    Square<S, N> A = random_symmetric<S, N>(random);
    A = (S(200) * A).array().round();  // subnormal multiples keep every digit
    Square<S, N> Q = A;
    const Eigen::Matrix<S, N, 1> values = diagonalise_by_ql(Q);
    for (const S scale : {Limits::denorm_min(), S(16) * Limits::denorm_min(), Limits::min(), std::ldexp(S(1), 100)}) {
        CAPTURE(scale);
        Square<S, N> scaled_Q = scale * A;
        const Eigen::Matrix<S, N, 1> scaled_values = diagonalise_by_ql(scaled_Q);
        CHECK(scaled_Q == Q);
        CHECK((scaled_values - scale * values).cwiseAbs().maxCoeff() <=
              std::max(Limits::denorm_min(), scale * Limits::epsilon()));
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
