// SPDX-License-Identifier: MIT
#include <softtissue/sparse/default_cholesky.hpp>

#include <softtissue/core/notation.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("the default factorisation solves, and refuses an indefinite matrix", S, float,
                   double) {
    Eigen::SparseMatrix<S> A(3, 3);
    A.setIdentity();
    A.coeffRef(0, 0) = S(4);
    A.coeffRef(1, 0) = A.coeffRef(0, 1) = S(1);
    DefaultCholesky<S> cholesky;
    cholesky.compute(A);
    REQUIRE(cholesky.info() == Eigen::Success);
    const VectorX<S> b = VectorX<S>::LinSpaced(3, S(1), S(3));
    CHECK((A * cholesky.solve(b) - b).norm() <= S(8) * std::numeric_limits<S>::epsilon() * b.norm());

    A.coeffRef(2, 2) = S(-1);
    cholesky.factorize(A);
    CHECK(cholesky.info() != Eigen::Success);
}
