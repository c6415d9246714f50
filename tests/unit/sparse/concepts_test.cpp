// SPDX-License-Identifier: MIT
#include <softtissue/sparse/concepts.hpp>

#include <softtissue/sparse/default_cholesky.hpp>

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

TEST_CASE("a solver of one's own needs the five verbs and no base class") {
    CHECK(SparseCholesky<Complete, double>);
}
