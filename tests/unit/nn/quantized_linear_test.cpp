// SPDX-License-Identifier: MIT
#include <softtissue/nn/quantized_linear.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
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

/// A layer as it was trained: 700 outputs, more than a range of rows.
template <class S>
struct Trained {
    typename Linear<S>::WeightMatrix weight{700, 50};
    VectorX<S> bias{700};
    MatrixX<S> x{50, 3};

    Trained() {
        RandomGenerator random(1);
        const auto fill = [&random](auto& matrix) {
            for (Index k = 0; k < matrix.size(); ++k) {
                matrix.data()[k] = S(random.uniform(-1, 1));
            }
        };
        fill(weight);
        fill(bias);
        fill(x);
        weight.row(5).setZero();
        weight.row(6) *= S(1e6);
        weight.row(7) *= S(1e-40);
    }
};

}  // namespace

TEST_CASE_TEMPLATE("the error of a layer stays within the bound of its roundings", W, BFloat16Weights, Int8Weights,
                   Int4Weights) {
    const auto check = [](auto zero) {
        using S = decltype(zero);
        constexpr bool is_float_column = std::is_same_v<typename W::Columns, FloatColumns>;
        const Trained<S> trained;
        const QuantizedLinear<S, W> layer(trained.weight, trained.bias, "layer");
        typename W::Columns scratch;
        MatrixX<S> y(700, 3);
        layer.forward_into(trained.x, scratch, y);
        double worst = 0;
        for (Index s = 0; s < 3; ++s) {
            const double peak = double(trained.x.col(s).cwiseAbs().maxCoeff());
            const double half_step = is_float_column ? peak * 6e-8 : 0.505 * peak / DigitColumns::largest;
            for (Index r = 0; r < 700; ++r) {
                double expected = double(trained.bias(r)), bound = 1e-7, magnitudes = std::abs(expected);
                for (Index k = 0; k < 50; ++k) {
                    const double w = double(trained.weight(r, k)), stored = layer.rows().value(r, k);
                    const double x = double(trained.x(k, s));
                    expected += w * x;
                    bound += std::abs((w - stored) * x) + std::abs(stored) * half_step;
                    magnitudes += std::abs(stored * x);
                }
                bound += 50 * 6e-8 * magnitudes;
                worst = std::max(worst, std::abs(double(y(r, s)) - expected) / bound);
            }
        }
        CHECK(worst <= 1.0);
        CHECK(worst > 0.05);  // the bound says something
        CHECK(y(5, 1) == trained.bias(5));
    };
    check(0.0F);
    check(0.0);
}

TEST_CASE_TEMPLATE("the number of samples changes no bit", W, BFloat16Weights, Int8Weights, Int4Weights) {
    const Trained<float> trained;
    const QuantizedLinear<float, W> layer(trained.weight, trained.bias, "layer");
    typename W::Columns scratch;
    layer.reserve(scratch, 3);
    MatrixX<float> y(700, 3), again(700, 3), one(700, 1);
    layer.forward_into(trained.x, scratch, y);
    for (Index s = 0; s < 3; ++s) {
        layer.forward_into(trained.x.col(s), scratch, one);
        CHECK(one == y.col(s));
    }
}

TEST_CASE_TEMPLATE("layers that threads made and run have the same bits", W, BFloat16Weights, Int8Weights,
                   Int4Weights) {
    const Trained<float> trained;
    const auto result = [&](const auto& executor) {
        const QuantizedLinear<float, W> layer(trained.weight, trained.bias, "layer", executor);
        typename W::Columns scratch;
        MatrixX<float> y(700, 3);
        layer.forward_into(trained.x, scratch, y, executor);
        return y;
    };
    const MatrixX<float> expected = result(SequentialExecutor{});
    CHECK(result(ThreadExecutor(2)) == expected);
    CHECK(result(ThreadExecutor(3)) == expected);
}

TEST_CASE("weights and biases that are not finite are refused") {
    Trained<float> trained;
    using Layer = QuantizedLinear<float, Int8Weights>;
    CHECK(refusal([&] { Layer(trained.weight, trained.bias.head(3), "network: 0.weight"); }) ==
          "network: 0.weight: 3 biases, expected 700 finite numbers");
    trained.weight(650, 7) = std::numeric_limits<float>::quiet_NaN();
    CHECK(refusal([&] { Layer(trained.weight, trained.bias, "network: 0.weight"); }) ==
          "network: 0.weight: weight (650, 7) is nan, expected a finite number");
    trained.bias(2) = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(Layer(trained.weight, trained.bias, "network: 0.weight"), InvalidInput);
}
