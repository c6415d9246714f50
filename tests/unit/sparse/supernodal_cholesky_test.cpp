// SPDX-License-Identifier: MIT
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/concepts.hpp>

#include <Eigen/SparseCholesky>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

static_assert(SparseCholesky<SupernodalCholesky<float>, float>);
static_assert(SparseCholesky<SupernodalCholesky<double>, double>);

namespace {

template <class S>
Eigen::SparseMatrix<S> matrix_of(int n, const std::vector<Eigen::Triplet<S>>& entries) {
    Eigen::SparseMatrix<S> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Diagonally dominant, `entries` off-diagonal pairs at random places; the lower triangle or both.
template <class S>
Eigen::SparseMatrix<S> random_matrix(int n, int entries, std::uint64_t seed, bool only_lower) {
    RandomGenerator random(seed);
    std::vector<Eigen::Triplet<S>> triplets;
    for (int i = 0; i < n; ++i) {
        triplets.emplace_back(i, i, S(1));
    }
    for (int k = 0; k < entries; ++k) {
        const int i = int(random.index(n));
        const int j = int(random.index(n));
        const S value = S(random.uniform(-1, 1));
        if (i != j) {
            triplets.emplace_back(i, i, std::abs(value));
            triplets.emplace_back(j, j, std::abs(value));
            triplets.emplace_back(std::max(i, j), std::min(i, j), value);
            if (!only_lower) {
                triplets.emplace_back(std::min(i, j), std::max(i, j), value);
            }
        }
    }
    return matrix_of(n, triplets);
}

/// Springs of random 3x3 stiffness along the edges of a grid of vertices and its diagonals, with a little of the identity.
template <class S>
BlockMatrix<S> grid(int size, S shift, std::uint64_t seed) {
    const auto vertex = [&](int x, int y, int z) { return std::int32_t((z * size + y) * size + x); };
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (int z = 0; z < size; ++z) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                for (int step = 1; step < 8; ++step) {
                    const int i = x + step % 2, j = y + step / 2 % 2, k = z + step / 4;
                    if (i < size && j < size && k < size) {
                        edges.emplace_back(vertex(x, y, z), vertex(i, j, k));
                    }
                }
            }
        }
    }
    std::vector<std::vector<std::int32_t>> neighbours(size_t(size * size * size));
    for (const auto& [a, b] : edges) {
        neighbours[size_t(a)].push_back(b);
        neighbours[size_t(b)].push_back(a);
    }
    const BlockPattern pattern(neighbours);
    BlockMatrix<S> K(pattern);
    RandomGenerator random(seed);
    for (const auto& [a, b] : edges) {
        Matrix3<S> G;
        for (S& g : G.reshaped()) {
            g = S(random.uniform(-1, 1));
        }
        const Matrix3<S> block = G * G.transpose();
        K.add(a, pattern.rank(a, a), block);
        K.add(b, pattern.rank(b, b), block);
        K.add(a, pattern.rank(a, b), -block);
        K.add(b, pattern.rank(b, a), -block);
    }
    for (Index v = 0; v < pattern.num_columns(); ++v) {
        K.add(v, pattern.rank(v, std::int32_t(v)), shift * Matrix3<S>::Identity());
    }
    return K;
}

template <class S>
VectorX<S> random_vector(Index n, std::uint64_t seed) {
    RandomGenerator random(seed);
    VectorX<S> b(n);
    for (S& value : b) {
        value = S(random.uniform(-1, 1));
    }
    return b;
}

template <class S>
void check_solves(const SupernodalCholesky<S>& cholesky, const Eigen::SparseMatrix<S>& A) {
    REQUIRE(cholesky.info() == Eigen::Success);
    const VectorX<S> b = random_vector<S>(A.rows(), 8);
    const VectorX<S> x = cholesky.solve(b);
    const VectorX<S> residual = A.template selfadjointView<Eigen::Lower>() * x - b;
    const S size = VectorX<S>(A.coeffs().cwiseAbs()).sum() / S(A.rows()) * x.norm() + b.norm();
    CHECK(residual.norm() <= S(10) * std::numeric_limits<S>::epsilon() * size);
}

}  // namespace

TEST_CASE_TEMPLATE("random matrices, one or both triangles", S, float, double) {
    for (const int n : {1, 2, 3, 10, 70, 300}) {
        for (const int entries : {0, n / 2, 2 * n, 6 * n}) {
            for (const bool only_lower : {false, true}) {
                CAPTURE(n);
                CAPTURE(entries);
                const Eigen::SparseMatrix<S> A = random_matrix<S>(n, entries, std::uint64_t(n + entries), only_lower);
                check_solves(SupernodalCholesky<S>(A), A);
            }
        }
    }
}

TEST_CASE_TEMPLATE("solid meshes of 3x3 blocks, as Eigen solves them", S, float, double) {
    for (const int size : {2, 5, 9}) {
        const BlockMatrix<S> K = grid<S>(size, S(0.3), 2);
        const SupernodalCholesky<S> cholesky(K.matrix());
        check_solves(cholesky, K.matrix());
        const Eigen::SimplicialLLT<Eigen::SparseMatrix<S>> eigen(K.matrix());
        const VectorX<S> b = random_vector<S>(K.matrix().rows(), 3);
        const VectorX<S> x = eigen.solve(b);
        CHECK((cholesky.solve(b) - x).norm() <= S(500) * std::numeric_limits<S>::epsilon() * x.norm());
    }
}

TEST_CASE_TEMPLATE("indefinite and singular matrices are told, the next one is factored as if nothing had been", S,
                   float, double) {
    BlockMatrix<S> K = grid<S>(5, S(0.3), 2);
    const SupernodalCholesky<S> fresh(K.matrix());
    SupernodalCholesky<S> cholesky(K.matrix());
    const VectorX<S> b = random_vector<S>(K.matrix().rows(), 3);
    for (const Index v : {0, 31, 62, 124}) {
        const std::int32_t rank = K.pattern().rank(v, std::int32_t(v));
        const Eigen::SparseMatrix<S> good = K.matrix();
        K.add(v, rank, -S(200) * Matrix3<S>::Identity());
        cholesky.factorize(K.matrix());
        CHECK(cholesky.info() == Eigen::NumericalIssue);
        K.add(v, rank, std::numeric_limits<S>::quiet_NaN() * Matrix3<S>::Identity());
        cholesky.factorize(K.matrix());
        CHECK(cholesky.info() == Eigen::NumericalIssue);
        K = grid<S>(5, S(0.3), 2);
        cholesky.factorize(K.matrix());
        REQUIRE(cholesky.info() == Eigen::Success);
        CHECK(cholesky.solve(b) == fresh.solve(b));
    }
    for (const int n : {1, 4, 20}) {
        Eigen::SparseMatrix<S> zero(n, n);
        zero.setIdentity();
        zero.coeffRef(n - 1, n - 1) = S(0);
        CHECK(SupernodalCholesky<S>(zero).info() == Eigen::NumericalIssue);
    }
    // ones everywhere: rank one without rounding
    Eigen::SparseMatrix<S> ones = MatrixX<S>::Ones(12, 12).sparseView();
    CHECK(SupernodalCholesky<S>(ones).info() == Eigen::NumericalIssue);
}

TEST_CASE("an analysis serves many matrices and many factors; another pattern needs another one") {
    const BlockMatrix<double> K = grid<double>(4, 0.3, 2), other = grid<double>(4, 0.5, 7),
                              larger = grid<double>(5, 0.3, 2);
    SupernodalCholesky<double> first(K.matrix());
    SupernodalCholesky<double> second(first.analysis());
    CHECK(second.info() != Eigen::Success);
    second.factorize(other.matrix());
    check_solves(second, other.matrix());
    check_solves(first, K.matrix());
    first.factorize(other.matrix());
    const VectorX<double> b = random_vector<double>(K.matrix().rows(), 3);
    CHECK(first.solve(b) == second.solve(b));
    CHECK_THROWS_WITH_AS(first.factorize(larger.matrix()), doctest::Contains("a matrix of 375 rows with "),
                         InvalidInput);
    first.compute(larger.matrix());
    check_solves(first, larger.matrix());
    CHECK_THROWS_AS(SupernodalCholesky<double>().factorize(K.matrix()), InvalidInput);
}

TEST_CASE("nothing to factor") {
    const Eigen::SparseMatrix<double> A(0, 0);
    const SupernodalCholesky<double> cholesky(A);
    CHECK(cholesky.info() == Eigen::Success);
    CHECK(cholesky.solve(VectorX<double>()).size() == 0);
}
