// SPDX-License-Identifier: MIT
#include <softtissue/nn/float_columns.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("float columns are the columns, then zeros, whatever was there before", S, float, double) {
    FloatColumns columns;
    columns.reserve(19, 3);
    columns.set<S>(MatrixX<S>::Constant(19, 3, S(7)));
    const MatrixX<S> x = (MatrixX<S>(3, 2) << S(1), S(4), S(2), S(5), S(1) / S(3), S(6)).finished();
    columns.set<S>(x);
    CHECK(columns.batch() == 2);
    for (Index sample = 0; sample < 2; ++sample) {
        for (Index k = 0; k < FloatColumns::block; ++k) {
            CHECK(columns.column(sample)[k] == (k < 3 ? float(x(k, sample)) : 0.0F));
        }
    }
}
