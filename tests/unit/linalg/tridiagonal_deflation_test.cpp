// SPDX-License-Identifier: MIT
#include <softtissue/linalg/tridiagonal_deflation.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/linalg/tridiagonal_form.hpp>
#include <softtissue/linalg/tridiagonal_laguerre.hpp>
#include <softtissue/linalg/tridiagonal_ql.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <type_traits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

constexpr int N = 9;

/// The rotations as a matrix.
template <class S>
Square<S, N> product(int first, const Eigen::Matrix<S, N, 1>& cosines, const Eigen::Matrix<S, N, 1>& sines) {
    Square<S, N> G = Square<S, N>::Identity();
    for (int i = N - 2; i >= first; --i) {
        const Eigen::Matrix<S, N, 1> q = G.col(i), next = G.col(i + 1);
        G.col(i) = cosines(i) * q - sines(i) * next;
        G.col(i + 1) = sines(i) * q + cosines(i) * next;
    }
    return G;
}

}  // namespace

TEST_CASE_TEMPLATE("an eigenvalue comes to the top, and the rest keeps the others", S, float, double) {
    RandomGenerator random(1);
    const S tolerance = S(64) * std::numeric_limits<S>::epsilon();
    using Wide = std::conditional_t<std::is_same_v<S, float>, double, long double>;
    int done = 0, tried = 0;
    for (const Square<S, N>& A : hard_matrices<S, N>(random)) {
        CAPTURE(A);
        TridiagonalForm<S, N> T(A);
        const Square<S, N> before = tridiagonal<S, N>(T.diagonal, T.below);
        Square<Wide, N> Q = before.template cast<Wide>();
        const S eigenvalue = S(diagonalise_by_ql(Q).minCoeff());
        Eigen::Matrix<S, N, 1> cosines, sines;
        const bool is_done = deflate(true, eigenvalue, 0, T.diagonal, T.below, cosines, sines);
        const Square<S, N> G = product<S>(0, cosines, sines);
        const Square<S, N> after = tridiagonal<S, N>(T.diagonal, T.below);
        CHECK((turned<S, N>(G, after) - before).cwiseAbs().maxCoeff() <= tolerance);
        if (is_done) {
            CHECK(T.below(0) == S(0));
            CHECK(std::abs(T.diagonal(0) - eigenvalue) <= tolerance);
        } else {
            CHECK(after == before);
        }
        done += is_done;
        ++tried;
    }
    CHECK(done > tried * 19 / 20);
}

TEST_CASE_TEMPLATE("of a part of the rows", S, float, double) {
    RandomGenerator random(2);
    const S tolerance = S(64) * std::numeric_limits<S>::epsilon();
    const int first = 4;
    for (int sample = 0; sample < 50; ++sample) {
        TridiagonalForm<S, N> T(random_symmetric<S, N>(random));
        T.below(first - 1) = S(0);
        const Square<S, N> before = tridiagonal<S, N>(T.diagonal, T.below);
        const S eigenvalue =
            smallest_eigenvalue(eigenvalue_bound(T.diagonal, T.below), true, first, T.diagonal, T.below);
        Eigen::Matrix<S, N, 1> cosines, sines;
        CHECK(deflate(true, eigenvalue, first, T.diagonal, T.below, cosines, sines));
        const Square<S, N> G = product<S>(first, cosines, sines);
        CHECK((turned<S, N>(G, tridiagonal<S, N>(T.diagonal, T.below)) - before).cwiseAbs().maxCoeff() <= tolerance);
        CHECK(std::abs(T.diagonal(first) - eigenvalue) <= tolerance);
    }
}

TEST_CASE("what is no eigenvalue, or not wanted, changes nothing") {
    RandomGenerator random(3);
    TridiagonalForm<double, N> T(random_symmetric<double, N>(random));
    const TridiagonalForm<double, N> before = T;
    Eigen::Matrix<double, N, 1> cosines, sines;
    Square<double, N> Q = tridiagonal<double, N>(T.diagonal, T.below);
    const double eigenvalue = diagonalise_by_ql(Q).minCoeff();
    for (const double other : {eigenvalue - 1e-6, eigenvalue + 1e-6, -10.0, 10.0, std::nan("")}) {
        CHECK_FALSE(deflate(true, other, 0, T.diagonal, T.below, cosines, sines));
        CHECK(T.diagonal == before.diagonal);
        CHECK(T.below == before.below);
        CHECK(product<double>(0, cosines, sines) == Square<double, N>::Identity());
    }
    CHECK_FALSE(deflate(false, eigenvalue, 0, T.diagonal, T.below, cosines, sines));
    CHECK(T.diagonal == before.diagonal);
}
