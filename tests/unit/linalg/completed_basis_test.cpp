// SPDX-License-Identifier: MIT
#include <softtissue/linalg/completed_basis.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// The largest difference of the products of columns from those of an orthonormal basis.
template <class S>
S deviation(const MatrixX<S>& basis) {
    S worst(0);
    for (Index i = 0; i < basis.cols(); ++i) {
        for (Index j = 0; j <= i; ++j) {
            worst = std::max(worst, std::abs(basis.col(i).dot(basis.col(j)) - S(i == j ? 1 : 0)));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE_TEMPLATE("a basis begins with the given columns and is orthonormal", S, float, double) {
    RandomGenerator random(1);
    const MatrixX<S> first = VectorX<S>::NullaryExpr(40, [&](Index) { return S(random.normal()); }).normalized();
    const MatrixX<S> all = completed_basis<S>(first);
    CHECK(all.col(0) == first);
    CHECK(deviation<S>(all) < S(20) * std::numeric_limits<S>::epsilon());
    for (const Index count : {0, 1, 17, 39, 40}) {
        const MatrixX<S> basis = completed_basis<S>(all.leftCols(count));
        CHECK(basis.leftCols(count) == all.leftCols(count));
        CHECK(deviation<S>(basis) < S(20) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("axes among the columns leave the others") {
    const MatrixX<double> basis = completed_basis<double>(MatrixX<double>::Identity(5, 5).rightCols(3));
    CHECK(basis.rightCols(2) == MatrixX<double>::Identity(5, 5).leftCols(2));
}

TEST_CASE("more columns than rows are refused") {
    CHECK_THROWS_WITH_AS(completed_basis<float>(MatrixX<float>::Ones(2, 3)),
                         "basis: 3 columns of 2 numbers, expected at most 2", InvalidInput);
}
