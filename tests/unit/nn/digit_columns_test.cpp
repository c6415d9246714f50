// SPDX-License-Identifier: MIT
#include <softtissue/nn/digit_columns.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

struct Digits {
    int high, low;
};

Digits digits_of(const DigitColumns& columns, Index sample, Index k) {
    const std::int32_t* const pair = columns.column(sample) + k / 4 * 2;
    const auto byte = [&](std::int32_t word) { return int(static_cast<std::int8_t>(word >> (8 * (k % 4)) & 255)); };
    return {byte(pair[0]), byte(pair[1])};
}

/// The largest error in steps.
template <class S>
double largest_error(const DigitColumns& columns, const MatrixX<S>& x) {
    double worst = 0;
    for (Index sample = 0; sample < x.cols(); ++sample) {
        const DigitColumns::Summary& summary = columns.summary(sample);
        int high_sum = 0, low_sum = 0;
        for (Index k = 0; k < x.rows(); ++k) {
            const Digits digits = digits_of(columns, sample, k);
            CHECK(digits.high >= -127);
            const double value = double(summary.step) * (256 * digits.high + digits.low);
            worst = std::max(worst, std::abs(value - double(x(k, sample))) / double(summary.step));
            high_sum += digits.high;
            low_sum += digits.low;
        }
        CHECK(summary.high_sum == high_sum);
        CHECK(summary.low_sum == low_sum);
    }
    return worst;
}

}  // namespace

TEST_CASE_TEMPLATE("digits are within half a step of the numbers, each column by its own step", S, float, double) {
    RandomGenerator random(1);
    DigitColumns columns;
    for (const double size : {1e-32, 1.0, 3e38}) {
        for (const Index depth : {1, 3, 8, 37}) {
            MatrixX<S> x = MatrixX<S>::NullaryExpr(depth, 3, [&] { return S(size * random.uniform(-1, 1)); });
            x(0, 0) = S(size);
            x(0, 1) = S(-size);
            columns.set<S>(x);
            CHECK(largest_error(columns, x) <= 0.51);
            CHECK(columns.summary(0).step == doctest::Approx(size / DigitColumns::largest));
            CHECK(columns.summary(1).step == columns.summary(0).step);
        }
    }
}

TEST_CASE("the rest of the last block is zero, whatever was there before") {
    DigitColumns columns;
    columns.set<float>(MatrixX<float>::Constant(16, 1, 3.0F));
    columns.set<float>(MatrixX<float>::Constant(9, 1, 1.0F));
    for (Index k = 9; k < 16; ++k) {
        CHECK(digits_of(columns, 0, k).high == 0);
        CHECK(digits_of(columns, 0, k).low == 0);
    }
}

TEST_CASE("columns of zeros and of next to nothing have step zero, others with NaN or infinity step NaN") {
    DigitColumns columns;
    MatrixX<float> x = MatrixX<float>::Zero(5, 4);
    x(1, 1) = 1e-34F;
    x(2, 2) = std::numeric_limits<float>::quiet_NaN();
    x(3, 3) = -std::numeric_limits<float>::infinity();
    columns.set<float>(x);
    CHECK(columns.summary(0).step == 0.0F);
    CHECK(columns.summary(1).step == 0.0F);
    CHECK(std::isnan(columns.summary(2).step));
    CHECK(std::isnan(columns.summary(3).step));
    CHECK(digits_of(columns, 3, 3).high == 0);
    columns.set<double>(MatrixX<double>::Constant(1, 1, 1e39));
    CHECK(std::isnan(columns.summary(0).step));
}
