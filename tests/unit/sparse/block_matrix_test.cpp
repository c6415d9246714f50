// SPDX-License-Identifier: MIT
#include <softtissue/sparse/block_matrix.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// A random symmetric pattern of `n` columns.
std::vector<std::vector<std::int32_t>> random_neighbours(Index n, RandomGenerator& random) {
    std::vector<std::vector<std::int32_t>> neighbours(static_cast<size_t>(n));
    for (Index k = 0; k < 2 * n; ++k) {
        const Index i = random.index(n), j = random.index(n);
        neighbours[size_t(i)].push_back(std::int32_t(j));
        neighbours[size_t(j)].push_back(std::int32_t(i));
    }
    return neighbours;
}

}  // namespace

TEST_CASE_TEMPLATE("blocks land where a triplet assembly puts them", Scalar, float, double) {
    RandomGenerator random(3);
    const Index n = 17;
    const BlockPattern pattern(random_neighbours(n, random));
    BlockMatrix<Scalar> matrix(pattern);
    MatrixX<Scalar> dense = MatrixX<Scalar>::Zero(3 * n, 3 * n);
    std::vector<Eigen::Triplet<Scalar>> triplets;
    for (int twice = 0; twice < 2; ++twice) {
        for (Index j = 0; j < n; ++j) {
            for (std::int32_t rank = 0; rank < std::int32_t(pattern.rows(j).size()); ++rank) {
                const Matrix3<Scalar> block = random_normal<Matrix3<Scalar>>(random);
                const Index i = pattern.rows(j)[size_t(rank)];
                matrix.add(j, rank, block);
                dense.template block<3, 3>(3 * i, 3 * j) += block;
                for (int a = 0; a < 3; ++a) {
                    for (int b = 0; b < 3; ++b) {
                        triplets.emplace_back(int(3 * i + a), int(3 * j + b), block(a, b));
                    }
                }
            }
        }
    }
    Eigen::SparseMatrix<Scalar> reference(3 * n, 3 * n);
    reference.setFromTriplets(triplets.begin(), triplets.end());
    CHECK(matrix.matrix().isCompressed());
    CHECK(matrix.matrix().nonZeros() == 9 * pattern.num_blocks());
    CHECK(matrix.matrix().nonZeros() == reference.nonZeros());
    CHECK((matrix.matrix().toDense() - dense).cwiseAbs().maxCoeff() == Scalar(0));
    CHECK((matrix.matrix() - reference).norm() == Scalar(0));
    matrix.set_zero();
    CHECK(matrix.matrix().norm() == Scalar(0));
    CHECK(matrix.matrix().nonZeros() == 9 * pattern.num_blocks());
}

TEST_CASE_TEMPLATE("a symmetric matrix multiplies like Eigen's, with the same bits for any executor", Scalar, float,
                   double) {
    RandomGenerator random(4);
    const Index n = 23;
    const BlockPattern pattern(random_neighbours(n, random));
    BlockMatrix<Scalar> matrix(pattern);
    for (Index j = 0; j < n; ++j) {
        for (const std::int32_t i : pattern.rows(j)) {
            if (i <= j) {
                Matrix3<Scalar> block = random_normal<Matrix3<Scalar>>(random);
                if (i == j) {
                    block = (block + block.transpose()).eval();
                }
                matrix.add(j, pattern.rank(j, i), block);
                if (i < j) {
                    matrix.add(i, pattern.rank(i, std::int32_t(j)), block.transpose());
                }
            }
        }
    }
    const VectorX<Scalar> x = VectorX<Scalar>::NullaryExpr(3 * n, [&] { return Scalar(random.normal()); });
    VectorX<Scalar> y, y_threads;
    matrix.multiply_into(x, y, SequentialExecutor{});
    matrix.multiply_into(x, y_threads, ThreadExecutor(3));
    const VectorX<Scalar> expected = matrix.matrix() * x;
    // a row has fewer than 64 entries of size 1
    CHECK((y - expected).cwiseAbs().maxCoeff() < 64 * 8 * std::numeric_limits<Scalar>::epsilon());
    CHECK(y == y_threads);
}
