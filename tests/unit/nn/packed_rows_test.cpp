// SPDX-License-Identifier: MIT
#include <softtissue/nn/packed_rows.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/nn/bfloat16_weights.hpp>
#include <softtissue/nn/int4_weights.hpp>
#include <softtissue/nn/int8_weights.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

MatrixX<float> random_matrix(Index rows, Index columns, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<float>::NullaryExpr(rows, columns, [&random] { return float(random.uniform(-1, 1)); });
}

/// `columns` are the rows of the matrix.
template <class W>
PackedRows<W> packed(const MatrixX<float>& columns) {
    PackedRows<W> result(columns.cols(), columns.rows());
    for (Index r = 0; r < columns.cols(); ++r) {
        result.set_row(r, columns.col(r).data(), "test");
    }
    return result;
}

template <class W>
MatrixX<float> product(const PackedRows<W>& W_, Index first, Index count, const MatrixX<float>& x) {
    typename W::Columns columns;
    columns.template set<float>(x);
    MatrixX<float> y = MatrixX<float>::Constant(count, x.cols(), 0.5F);
    W_.add_product(first, count, columns, y.data(), count);
    return y;
}

}  // namespace

TEST_CASE_TEMPLATE("stored rows are the rounded ones", W, BFloat16Weights, Int8Weights, Int4Weights) {
    for (const Index depth : {1, 2, 3, 7, 8, 9, 33}) {
        MatrixX<float> rows = random_matrix(depth, 70, 1);
        rows.col(3).setZero();
        rows.col(66) *= 1e30F;
        const PackedRows<W> stored = packed<W>(rows);
        for (Index r = 0; r < rows.cols(); ++r) {
            const float step = W::step(rows.col(r).data(), depth);
            CHECK(stored.step(r) == step);
            for (Index k = 0; k < depth; ++k) {
                CHECK(stored.value(r, k) == W::value(W::code(rows(k, r), step), step));
            }
        }
    }
}

TEST_CASE_TEMPLATE("products of the stored rows with the rounded columns", W, BFloat16Weights, Int8Weights,
                   Int4Weights) {
    constexpr bool is_exact = std::is_same_v<typename W::Columns, FloatColumns>;
    for (const Index depth : {1, 2, 7, 8, 9, 100, 601}) {
        const PackedRows<W> stored = packed<W>(random_matrix(depth, 83, 2));
        const MatrixX<float> x = random_matrix(depth, 7, 3);
        const MatrixX<float> y = product<W>(stored, 0, 83, x);
        double worst = 0;
        for (Index s = 0; s < x.cols(); ++s) {
            const double half_step =
                is_exact ? 0 : 0.505 * double(x.col(s).cwiseAbs().maxCoeff()) / DigitColumns::largest;
            for (Index r = 0; r < 83; ++r) {
                double expected = 0.5, magnitudes = 0.5, weights = 0;
                for (Index k = 0; k < depth; ++k) {
                    const double w = stored.value(r, k);
                    expected += w * double(x(k, s));
                    magnitudes += std::abs(w * double(x(k, s)));
                    weights += std::abs(w);
                }
                const double rounding = (is_exact ? double(depth) : 8.0) * 6e-8;
                const double bound = weights * half_step + rounding * magnitudes + 1e-7;
                worst = std::max(worst, std::abs(double(y(r, s)) - expected) / bound);
            }
        }
        CHECK(worst <= 1.0);
    }
}

TEST_CASE_TEMPLATE("an entry has the same bits whatever the other rows and samples are", W, BFloat16Weights,
                   Int8Weights, Int4Weights) {
    const PackedRows<W> stored = packed<W>(random_matrix(37, 200, 4));
    const MatrixX<float> x = random_matrix(37, 7, 5);
    const MatrixX<float> y = product<W>(stored, 0, 200, x);
    CHECK(product<W>(stored, 64, 100, x) == y.middleRows(64, 100));
    CHECK(product<W>(stored, 192, 8, x) == y.bottomRows(8));
    for (Index s = 0; s < x.cols(); ++s) {
        CHECK(product<W>(stored, 0, 200, x.col(s)) == y.col(s));
    }
}

TEST_CASE("the result may be of doubles, a part of a larger array") {
    const PackedRows<Int8Weights> stored = packed<Int8Weights>(random_matrix(20, 9, 6));
    const MatrixX<float> x = random_matrix(20, 2, 7);
    DigitColumns columns;
    columns.set<float>(x);
    MatrixX<double> y = MatrixX<double>::Constant(11, 2, 0.5);
    stored.add_product(0, 9, columns, y.data() + 1, y.outerStride());
    const MatrixX<float> expected = product<Int8Weights>(stored, 0, 9, x);
    CHECK((y.middleRows(1, 9) - expected.cast<double>()).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((y.row(0).array() == 0.5).all());
    CHECK((y.row(10).array() == 0.5).all());
}

TEST_CASE_TEMPLATE("columns that are not finite give NaN, not numbers", W, BFloat16Weights, Int8Weights, Int4Weights) {
    const PackedRows<W> stored = packed<W>(random_matrix(10, 5, 8));
    MatrixX<float> x = random_matrix(10, 2, 9);
    x(4, 1) = std::numeric_limits<float>::quiet_NaN();
    const MatrixX<float> y = product<W>(stored, 0, 5, x);
    CHECK(y.col(0).allFinite());
    CHECK(y.col(1).array().isNaN().all());
}

TEST_CASE("integer weights are a quarter and an eighth of floats in memory") {
    CHECK(PackedRows<BFloat16Weights>(6400, 800).num_bytes() <= 6400 * 800 * 2 + 9000);
    CHECK(PackedRows<Int8Weights>(6400, 800).num_bytes() <= 6400 * 804 + 9000);
    CHECK(PackedRows<Int4Weights>(6400, 800).num_bytes() <= 6400 * 404 + 9000);
}

TEST_CASE_TEMPLATE("weights that cannot be stored are refused by name, row and input", W, BFloat16Weights, Int8Weights,
                   Int4Weights) {
    PackedRows<W> rows(3, 4);
    VectorX<float> row = VectorX<float>::Ones(4);
    row(2) = std::numeric_limits<float>::infinity();
    CHECK(refusal([&] { rows.set_row(1, row.data(), "network: 3.weight"); }) ==
          "network: 3.weight: weight (1, 2) is inf, expected a finite number");
    const VectorX<double> large = VectorX<double>::Constant(4, 1e39);
    CHECK(refusal([&] { rows.set_row(0, large.data(), "w"); }) ==
          "w: weight (0, 0) is 1e+39, expected a finite number");
    CHECK(refusal([] { PackedRows<W>(1, 65537); }) ==
          "packed weights: 1 rows of 65537 inputs, expected at least one of each and at most 65536 inputs");
    CHECK_THROWS_AS(PackedRows<W>(0, 1), InvalidInput);
}
