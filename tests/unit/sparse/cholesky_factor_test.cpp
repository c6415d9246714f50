// SPDX-License-Identifier: MIT
#include <softtissue/sparse/cholesky_factor.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace softtissue;

namespace {

/// The Laplacian of a ring of n vertices with chords, plus a little of the identity.
Eigen::SparseMatrix<double> ring(int n, double shift) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
        for (const int step : {1, 7}) {
            const int j = (i + step) % n;
            entries.emplace_back(i, i, 1.0);
            entries.emplace_back(j, j, 1.0);
            entries.emplace_back(i, j, -1.0);
            entries.emplace_back(j, i, -1.0);
        }
        entries.emplace_back(i, i, shift);
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Each unknown of A replaced by a pair with the same neighbours.
Eigen::SparseMatrix<double> in_pairs(const Eigen::SparseMatrix<double>& A) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < A.cols(); ++j) {
        for (Eigen::SparseMatrix<double>::InnerIterator entry(A, j); entry; ++entry) {
            const int i = int(entry.row());
            entries.emplace_back(2 * i, 2 * j, 2 * entry.value());
            entries.emplace_back(2 * i + 1, 2 * j + 1, entry.value());
            entries.emplace_back(2 * i, 2 * j + 1, 0.5 * entry.value());
            entries.emplace_back(2 * i + 1, 2 * j, 0.5 * entry.value());
        }
    }
    Eigen::SparseMatrix<double> pairs(2 * A.rows(), 2 * A.cols());
    pairs.setFromTriplets(entries.begin(), entries.end());
    return pairs;
}

template <class S>
void check_solves(const Eigen::SparseMatrix<double>& A, double condition) {
    const Index n = A.cols();
    const CholeskyFactor<S> factor(A, "ring");
    REQUIRE(factor.size() == n);
    REQUIRE(factor.num_places() >= n);
    CHECK(factor.num_entries() > n);
    RandomGenerator random(3);
    Matrix3X<double> x(3, n);
    for (Index v = 0; v < n; ++v) {
        x.col(v) = random_normal<Vector3<double>>(random);
    }
    const Matrix3X<double> b = x * A;
    typename CholeskyFactor<S>::RightHandSides y =
        CholeskyFactor<S>::RightHandSides::Constant(4, factor.num_places(), S(-7));
    for (Index u = 0; u < n; ++u) {
        REQUIRE(y(0, factor.place(u)) == S(-7));  // no place twice
        y.col(factor.place(u)) << b.col(u).template cast<S>(), S(0);
    }
    factor.solve_in_place(y);
    double error = 0;
    for (Index u = 0; u < n; ++u) {
        error = std::max(error, (y.col(factor.place(u)).template head<3>().template cast<double>() - x.col(u)).norm());
        CHECK(y(3, factor.place(u)) == S(0));
        y.col(factor.place(u)).setZero();
    }
    CHECK(error <= condition * 8 * double(std::numeric_limits<S>::epsilon()) * x.colwise().norm().maxCoeff());
    CHECK(y.allFinite());
}

}  // namespace

TEST_CASE_TEMPLATE("solves for three right-hand sides, each unknown at its place", S, float, double) {
    // condition number below (4 * 4 + 0.5) / 0.5 = 33, times 3.3 for pairs
    check_solves<S>(ring(60, 0.5), 33.0);
    check_solves<S>(in_pairs(ring(60, 0.5)), 109.0);
}

TEST_CASE_TEMPLATE("groups of four and single unknowns: places without an unknown", S, float, double) {
    // cliques of five, whose first ones are a chain
    std::vector<Eigen::Triplet<double>> entries;
    const int n = 41;
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, 10.0);
        for (int j = 0; j < i; ++j) {
            if (j / 5 == i / 5 || (j % 5 == 0 && j / 5 + 1 == i / 5)) {
                entries.emplace_back(i, j, -1.0);
                entries.emplace_back(j, i, -1.0);
            }
        }
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    check_solves<S>(A, 8.0);
    CHECK(CholeskyFactor<S>(A, "chain").num_places() > n);
}

TEST_CASE_TEMPLATE("large enough for two threads: the same bits for any executor, again and again", S, float, double) {
    // a grid: its elimination tree has two large subtrees
    const int width = 60;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < width * width; ++i) {
        entries.emplace_back(i, i, 4.5);
        for (const int j : {i % width == 0 ? -1 : i - 1, i - width}) {
            if (j >= 0) {
                entries.emplace_back(i, j, -1.0);
                entries.emplace_back(j, i, -1.0);
            }
        }
    }
    Eigen::SparseMatrix<double> A(width * width, width * width);
    A.setFromTriplets(entries.begin(), entries.end());
    for (const bool pairs : {false, true}) {
        const Eigen::SparseMatrix<double> B = pairs ? in_pairs(A) : A;
        check_solves<S>(B, pairs ? 56.0 : 17.0);
        const CholeskyFactor<S> factor(B, "grid");
        CHECK(factor.num_places() > B.cols());  // there is more than one part
        CHECK(factor.num_bytes() > factor.num_entries() * Index(sizeof(S)));
        RandomGenerator random(4);
        typename CholeskyFactor<S>::RightHandSides b(4, factor.num_places());
        for (Index k = 0; k < b.size(); ++k) {
            b.data()[k] = S(random.normal());
        }
        typename CholeskyFactor<S>::RightHandSides alone = b, memory = b;
        factor.solve_in_place(alone);
        for (const int num_threads : {1, 2, 3}) {
            const ThreadExecutor threads(num_threads);
            for (Index u = 0; u < factor.size(); ++u) {  // only the columns of unknowns: the others hold what they held
                memory.col(factor.place(u)) = b.col(factor.place(u));
            }
            factor.solve_in_place(memory, threads);
            bool all_same = true;
            for (Index u = 0; u < factor.size(); ++u) {
                all_same = all_same && memory.col(factor.place(u)) == alone.col(factor.place(u));
            }
            CHECK(all_same);
        }
    }
}

TEST_CASE("a singular or indefinite matrix is refused by name") {
    CHECK_THROWS_WITH_AS((CholeskyFactor<double>(ring(20, 0.0), "ring")), doctest::Contains("ring: "), InvalidInput);
    CHECK_THROWS_WITH_AS((CholeskyFactor<double>(ring(20, -1.0), "the ring")),
                         "the ring: the matrix is not positive definite", InvalidInput);
}
