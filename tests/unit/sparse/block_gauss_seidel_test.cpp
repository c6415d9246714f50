// SPDX-License-Identifier: MIT
#include <softtissue/sparse/block_gauss_seidel.hpp>

#include <softtissue/core/executor.hpp>

#include <support/spring_lattice.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// y = D x with D = the diagonal blocks of A over the relaxation, plus (off_diagonal > 0) L x or (< 0) L^T x.
template <class S>
VectorX<S> plain_product(const BlockMatrix<S>& A, const VectorX<S>& x, int off_diagonal) {
    VectorX<S> y = VectorX<S>::Zero(x.size());
    for (Index j = 0; j < A.matrix().cols(); ++j) {
        for (typename BlockMatrix<S>::SparseMatrix::InnerIterator entry(A.matrix(), j); entry; ++entry) {
            const Index below = entry.row() / 3 - j / 3;
            if (below == 0) {
                y(entry.row()) += entry.value() * x(j) / BlockGaussSeidel<S>::relaxation;
            } else if (below * off_diagonal > 0) {
                y(entry.row()) += entry.value() * x(j);
            }
        }
    }
    return y;
}

template <class S>
VectorX<S> entered(const BlockGaussSeidel<S>& matrix, const VectorX<S>& b) {
    VectorX<S> v;
    matrix.enter(b, S(1), v);
    return v;
}

template <class S>
VectorX<S> left(const BlockGaussSeidel<S>& matrix, const VectorX<S>& v) {
    VectorX<S> scratch, p;
    matrix.leave(v, S(1), scratch, p);
    return p;
}

}  // namespace

TEST_CASE_TEMPLATE("outside and inside are one matrix, the preconditioner is two sweeps", Scalar, float, double) {
    const Scalar tolerance = Scalar(200) * std::numeric_limits<Scalar>::epsilon();
    for (const Index width : {1, 2, 5, 9}) {
        CAPTURE(width);
        RandomGenerator random{std::uint64_t(width)};
        const BlockMatrix<Scalar> A = spring_lattice<Scalar>(width, 7, 0.7, random);
        BlockGaussSeidel<Scalar> matrix;
        REQUIRE(matrix.factorize(A));
        REQUIRE(matrix.num_vertices() == 7 * width);
        const VectorX<Scalar> b = random_vector<Scalar>(21 * width, random);
        const VectorX<Scalar> v = entered(matrix, random_vector<Scalar>(21 * width, random));

        // A^ = enter A leave
        VectorX<Scalar> scratch, w, product;
        matrix.multiply_into(v, scratch, w);
        A.multiply_into(left(matrix, v), product, SequentialExecutor{});
        CHECK((w - entered(matrix, product)).norm() <= tolerance * w.norm());
        // enter is the transpose of leave
        const Scalar inside = entered(matrix, b).dot(v), outside = b.dot(left(matrix, v));
        CHECK(std::abs(inside - outside) <= tolerance * b.norm() * left(matrix, v).norm());
        // (D + L) D^-1 (D + L^T) z = b for z = leave(enter(b)): with y = D^-1 (D + L^T) z, z solves (D + L^T) z = D y
        const VectorX<Scalar> z = left(matrix, entered(matrix, b));
        const VectorX<Scalar> Dy = plain_product(A, z, -1);
        VectorX<Scalar> y(b.size());
        for (Index i = 0; i < matrix.num_vertices(); ++i) {
            const Matrix3<Scalar> D =
                Matrix3<Scalar>(A.matrix().block(3 * i, 3 * i, 3, 3)) / BlockGaussSeidel<Scalar>::relaxation;
            y.template segment<3>(3 * i) = D.inverse() * Dy.template segment<3>(3 * i);
        }
        CHECK((plain_product(A, y, 1) - b).norm() <= Scalar(10) * tolerance * b.norm());
        // the fourth number of every vertex stays 0
        for (Index i = 3; i < w.size(); i += 4) {
            CHECK(w(i) == Scalar(0));
        }
    }
}

TEST_CASE("a matrix of another precision, size and sparsity; nothing at all") {
    RandomGenerator random(7);
    BlockGaussSeidel<float> matrix;
    for (const Index width : {6, 3, 4}) {
        const BlockMatrix<double> A = spring_lattice<double>(width, 4, 1e12, random);
        REQUIRE(matrix.factorize(A));
        const VectorX<double> b = random_vector<double>(12 * width, random);
        VectorX<float> v, scratch;
        VectorX<double> p;
        matrix.enter(b, 1e3, v);
        matrix.leave(v, 1e-3, scratch, p);
        const double expected = double(BlockGaussSeidel<float>::relaxation) / 1e12;  // springs are negligible
        CHECK((p - expected * b).norm() < 1e-6 * p.norm());
    }
    REQUIRE(matrix.factorize(BlockMatrix<double>{BlockPattern(std::vector<std::vector<std::int32_t>>())}));
    CHECK(matrix.num_vertices() == 0);
    VectorX<float> v, scratch, w;
    matrix.enter(VectorX<double>(), 1.0, v);
    matrix.multiply_into(v, scratch, w);
    CHECK(w.size() == 0);
}

TEST_CASE_TEMPLATE("diagonal blocks that are not positive definite are refused", Scalar, float, double) {
    RandomGenerator random(9);
    BlockGaussSeidel<Scalar> matrix;
    const BlockMatrix<Scalar> A = spring_lattice<Scalar>(4, 4, 1, random);
    for (const Scalar bad :
         {Scalar(-100), std::numeric_limits<Scalar>::quiet_NaN(), std::numeric_limits<Scalar>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            BlockMatrix<Scalar> worse = A;
            Matrix3<Scalar> block = Matrix3<Scalar>::Zero();
            block(axis, axis) = bad;
            worse.add(9, worse.pattern().rank(9, 9), block);
            CHECK_FALSE(matrix.factorize(worse));
        }
    }
    CHECK(matrix.factorize(A));
}
