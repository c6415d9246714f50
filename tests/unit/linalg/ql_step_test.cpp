// SPDX-License-Identifier: MIT
#include <softtissue/linalg/ql_step.hpp>

#include <support/symmetric_matrices.hpp>

#include <softtissue/linalg/tridiagonal_ql.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

constexpr int N = 7;

template <class S>
struct Rows {
    Eigen::Matrix<S, N, 1> diagonal, below;

    explicit Rows(RandomGenerator& random) {
        for (int i = 0; i < N; ++i) {
            diagonal(i) = S(random.uniform(-1, 1));
            below(i) = S(i + 1 < N ? random.uniform(0.2, 1) : 0);
        }
    }

    Square<S, N> dense() const { return tridiagonal<S, N>(diagonal, below); }

    Eigen::Matrix<S, N, 1> eigenvalues() const {
        Square<S, N> A = dense();
        return diagonalise_by_ql(A);
    }

    /// One step; the product of its rotations.
    Square<S, N> step(bool is_active, int first, S shift) {
        Square<S, N> G = Square<S, N>::Identity();
        ql_step(is_active, first, shift, diagonal, below, [&G](int i, S cosine, S sine) {
            const Eigen::Matrix<S, N, 1> q = G.col(i), next = G.col(i + 1);
            G.col(i) = cosine * q - sine * next;
            G.col(i + 1) = sine * q + cosine * next;
        });
        return G;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("a step is a similarity that leaves the matrix tridiagonal", S, float, double) {
    RandomGenerator random(1);
    const S tolerance = S(16 * N) * std::numeric_limits<S>::epsilon();
    for (int sample = 0; sample < 50; ++sample) {
        Rows<S> T(random);
        const int first = sample % (N - 1);
        if (sample % 5 == 0) {
            T.below(3) = S(0);
        }
        const Square<S, N> before = T.dense();
        const Square<S, N> G = T.step(true, first, wilkinson_shift(T.diagonal, T.below, first));
        // The rows above `first` belong to others, and so does what couples them.
        Square<S, N> rebuilt = turned<S, N>(G, T.dense());
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j < N; ++j) {
                if (i >= first && j >= first) {
                    CHECK(std::abs(rebuilt(i, j) - before(i, j)) <= tolerance);
                }
            }
        }
    }
}

TEST_CASE("an eigenvalue as the shift comes to the top, whichever block it is of") {
    RandomGenerator random(2);
    for (int sample = 0; sample < 50; ++sample) {
        Rows<double> T(random);
        if (sample % 2 == 1) {
            T.below(sample % 5) = 0;
        }
        const double eigenvalue = T.eigenvalues()(sample % N);
        T.step(true, 0, eigenvalue);
        CAPTURE(sample);
        // One step leaves up to some thousand epsilon, another nothing; of a block that is not at the top likewise.
        T.step(true, 0, eigenvalue);
        CHECK(std::abs(T.below(0)) < 1e-9);
        CHECK(std::abs(T.diagonal(0) - eigenvalue) < 1e-9);
    }
}

TEST_CASE("rows that are not active stand still") {
    RandomGenerator random(3);
    Rows<float> T(random);
    const Square<float, N> before = T.dense();
    CHECK(T.step(false, 0, 0.5F) == Square<float, N>::Identity());
    CHECK(T.dense() == before);
}

TEST_CASE("Wilkinson's shift is the eigenvalue of the first two rows closer to the first") {
    Eigen::Vector3d diagonal(2, -1, 7), below(2, 1, 0);
    // 2 2; 2 -1: eigenvalues 3 and -2
    CHECK(wilkinson_shift(diagonal, below, 0) == doctest::Approx(3));
    diagonal(0) = -1;
    diagonal(1) = 2;
    CHECK(wilkinson_shift(diagonal, below, 0) == doctest::Approx(-2));
}
