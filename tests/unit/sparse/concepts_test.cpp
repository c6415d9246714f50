// SPDX-License-Identifier: MIT
#include <softtissue/sparse/concepts.hpp>

#include <softtissue/solver/direct_solver.hpp>

#include <Eigen/SparseCholesky>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {
struct NoFactorize {
    void analyzePattern(const Eigen::SparseMatrix<double>&) {}
    void compute(const Eigen::SparseMatrix<double>&) {}
    VectorX<double> solve(const VectorX<double>& b) { return b; }
    Eigen::ComputationInfo info() const { return Eigen::Success; }
};
struct NoInfo : NoFactorize {
    void factorize(const Eigen::SparseMatrix<double>&) {}
    bool info() const { return true; }
};
struct Complete : NoFactorize {
    void factorize(const Eigen::SparseMatrix<double>&) {}
};
}  // namespace

static_assert(SparseCholesky<DefaultCholesky<double>, double>);
static_assert(SparseCholesky<DefaultCholesky<float>, float>);
static_assert(SparseCholesky<Complete, double>);
static_assert(!SparseCholesky<NoFactorize, double>);
static_assert(!SparseCholesky<NoInfo, double>);

TEST_CASE_TEMPLATE("the default tells an indefinite matrix", Scalar, float, double) {
    Eigen::SparseMatrix<Scalar> A(2, 2);
    A.insert(0, 0) = Scalar(2);
    A.insert(1, 0) = Scalar(1);
    A.insert(0, 1) = Scalar(1);
    A.insert(1, 1) = Scalar(1);
    DefaultCholesky<Scalar> cholesky;
    cholesky.compute(A);
    CHECK(cholesky.info() == Eigen::Success);
    A.coeffRef(1, 1) = Scalar(0.25);
    cholesky.factorize(A);
    CHECK(cholesky.info() != Eigen::Success);
}
