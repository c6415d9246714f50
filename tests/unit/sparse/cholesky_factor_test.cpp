// SPDX-License-Identifier: MIT
#include <softtissue/sparse/cholesky_factor.hpp>

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

}  // namespace

TEST_CASE_TEMPLATE("solves for three right-hand sides in the order of its pivots", S, float, double) {
    const int n = 60;
    const Eigen::SparseMatrix<double> A = ring(n, 0.5);
    const CholeskyFactor<S> factor(A, "ring");
    REQUIRE(factor.size() == n);
    CHECK(factor.num_entries() > n);
    RandomGenerator random(3);
    Matrix3X<double> x(3, n);
    for (int v = 0; v < n; ++v) {
        x.col(v) = random_normal<Vector3<double>>(random);
    }
    const Matrix3X<double> b = x * A;
    Matrix3X<S> y(3, n);
    std::vector<bool> seen(size_t(n), false);
    for (int k = 0; k < n; ++k) {
        const std::int32_t row = factor.order()[size_t(k)];
        CHECK_FALSE(seen[size_t(row)]);
        seen[size_t(row)] = true;
        y.col(k) = b.col(row).template cast<S>();
    }
    factor.solve_in_place(y);
    double error = 0;
    for (int k = 0; k < n; ++k) {
        error = std::max(error, (y.col(k).template cast<double>() - x.col(factor.order()[size_t(k)])).norm());
    }
    // condition number below (4 * 4 + 0.5) / 0.5 = 33
    CHECK(error <= 33.0 * 8 * double(std::numeric_limits<S>::epsilon()) * x.colwise().norm().maxCoeff());
}

TEST_CASE("a singular or indefinite matrix is refused by name") {
    CHECK_THROWS_WITH_AS((CholeskyFactor<double>(ring(20, 0.0), "ring")), doctest::Contains("ring: "), InvalidInput);
    CHECK_THROWS_WITH_AS((CholeskyFactor<double>(ring(20, -1.0), "the ring")),
                         "the ring: the matrix is not positive definite", InvalidInput);
}
