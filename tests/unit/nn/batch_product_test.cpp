// SPDX-License-Identifier: MIT
#include <softtissue/nn/batch_product.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

template <class S>
struct Product {
    static constexpr Index rows = 7, columns = 9;
    MatrixX<S> W, x;  ///< W^T

    explicit Product(Index depth) {
        RandomGenerator random(1);
        const auto number = [&random] { return S(random.uniform(-1, 1)); };
        W = MatrixX<S>::NullaryExpr(depth, rows, number);
        x = MatrixX<S>::NullaryExpr(depth, columns, number);
    }

    MatrixX<S> value(Index first_row, Index num_rows, Index first, Index batch) const {
        MatrixX<S> y = MatrixX<S>::Constant(num_rows, batch, S(0.5));
        add_batch_product<S>(W.col(first_row).data(), x.middleCols(first, batch), y);
        return y;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("sums of every length, rows and samples that fill no tile", S, float, double) {
    for (const Index depth : {1, 3, 4, 15, 16, 17, 37, 200}) {
        const Product<S> product(depth);
        const MatrixX<S> y = product.value(0, 7, 0, 9);
        double worst = 0;
        for (Index r = 0; r < 7; ++r) {
            for (Index s = 0; s < 9; ++s) {
                double expected = 0.5;
                for (Index k = 0; k < depth; ++k) {
                    expected += double(product.W(k, r)) * double(product.x(k, s));
                }
                worst = std::max(worst, std::abs(double(y(r, s)) - expected));
            }
        }
        CHECK(worst <= double(depth + 1) * double(std::numeric_limits<S>::epsilon()));
    }
}

TEST_CASE_TEMPLATE("an entry has the same bits whatever the other rows and samples are", S, float, double) {
    const Product<S> product(37);
    const MatrixX<S> y = product.value(0, 7, 0, 9);
    for (Index r = 0; r < 7; ++r) {
        for (Index s = 0; s < 9; ++s) {
            CHECK(product.value(r, 1, s, 1)(0, 0) == y(r, s));
        }
    }
}

TEST_CASE("a part of a larger array of results") {
    const Product<double> product(20);
    MatrixX<double> y = MatrixX<double>::Constant(9, 5, 0.5);
    add_batch_product<double>(product.W.data(), product.x.leftCols(5), y.middleRows(1, 7));
    CHECK(y.middleRows(1, 7) == product.value(0, 7, 0, 5));
    CHECK((y.row(0).array() == 0.5).all());
    CHECK((y.row(8).array() == 0.5).all());
}
