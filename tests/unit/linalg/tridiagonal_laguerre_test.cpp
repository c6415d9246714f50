// SPDX-License-Identifier: MIT
#include <softtissue/linalg/tridiagonal_laguerre.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/linalg/tridiagonal_form.hpp>
#include <softtissue/linalg/tridiagonal_ql.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

constexpr int N = 9;

/// The smallest eigenvalue of the rows from `first` on.
template <class S>
S smallest_by_ql(const TridiagonalForm<S, N>& T, int first) {
    Square<S, N> A = tridiagonal<S, N>(T.diagonal, T.below);
    for (int i = 0; i < first; ++i) {  // no smaller ones
        A.row(i).setZero();
        A.col(i).setZero();
        A(i, i) = S(10);
    }
    return diagonalise_by_ql(A).minCoeff();
}

}  // namespace

TEST_CASE_TEMPLATE("the smallest eigenvalue is found from below", S, float, double) {
    RandomGenerator random(1);
    const S slack = S(64) * std::numeric_limits<S>::epsilon();
    for (const Square<S, N>& A : hard_matrices<S, N>(random)) {
        CAPTURE(A);
        const TridiagonalForm<S, N> T(A);
        const S bound = eigenvalue_bound(T.diagonal, T.below);
        for (const int first : {0, 3, N - 2}) {
            const S expected = smallest_by_ql(T, first);
            CHECK(bound <= expected + slack);
            const S found = smallest_eigenvalue(bound, true, first, T.diagonal, T.below);
            // Of several close ones some digits come, and the root of a difference may go past them by that of rounding.
            CHECK(found <= expected + std::sqrt(slack));
            CHECK(found >= bound - slack);
            CHECK(smallest_eigenvalue(bound, false, first, T.diagonal, T.below) == bound);
            // Asked for with a distance on both sides, from below with one whose powers are numbers.
            CHECK(has_only_eigenvalues_above(S(expected - S(0.01)), first, T.diagonal, T.below));
            CHECK_FALSE(has_only_eigenvalues_above(S(expected + slack), first, T.diagonal, T.below));
        }
    }
}

TEST_CASE_TEMPLATE("single eigenvalues are found to rounding", S, float, double) {
    RandomGenerator random(2);
    for (int sample = 0; sample < 200; ++sample) {
        const TridiagonalForm<S, N> T(random_symmetric<S, N>(random));
        const S found = smallest_eigenvalue(eigenvalue_bound(T.diagonal, T.below), true, 0, T.diagonal, T.below);
        CHECK(std::abs(found - smallest_by_ql(T, 0)) <= S(64) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("a lane of a pack depends on no other", S, float, double) {
    constexpr int width = natural_lanes < S >> 1 ? natural_lanes<S> : 4;
    using Lanes = Pack<S, width>;
    RandomGenerator random(3);
    const std::vector<Square<S, N>> list = hard_matrices<S, N>(random);
    const auto found = [](const TridiagonalForm<Lanes, N>& T) {
        return smallest_eigenvalue(eigenvalue_bound(T.diagonal, T.below), Lanes(0) < Lanes(1), 0, T.diagonal, T.below);
    };
    const Lanes together =
        found(TridiagonalForm<Lanes, N>(packed_matrix<width>([&](int i) { return list[std::size_t(i)]; })));
    for (int i = 0; i < width; ++i) {
        const Lanes alone =
            found(TridiagonalForm<Lanes, N>(packed_matrix<width>([&](int) { return list[std::size_t(i)]; })));
        CHECK(together[i] == alone[i]);
    }
}
