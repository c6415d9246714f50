// SPDX-License-Identifier: MIT
#include <softtissue/nn/quantized_mlp.hpp>

#include <softtissue/core/thread_executor.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

template <class S>
Mlp<S> trained_network() {
    Mlp<S> network({.inputs = 20, .hidden = {40, 40, 24}, .outputs = 700});
    network.initialize(1);
    return network;
}

template <class S>
MatrixX<S> inputs(Index samples, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(20, samples, [&random] { return S(random.normal()); });
}

template <class S>
MatrixX<S> outputs_of(const auto& network, const MatrixX<S>& x) {
    auto scratch = network.make_scratch(x.cols());
    MatrixX<S> y(network.sizes().outputs, x.cols());
    network.infer_into(x, scratch, y);
    return y;
}

constexpr std::array small_formats{WeightFormat::bfloat16, WeightFormat::int8, WeightFormat::int4};

}  // namespace

TEST_CASE_TEMPLATE("the outputs are those of the network, but for its rounded weights", S, float, double) {
    const Mlp<S> network = trained_network<S>();
    const MatrixX<S> x = inputs<S>(30, 2), expected = outputs_of<S>(network, x);
    double last = 0;
    for (const WeightFormat format : small_formats) {
        const QuantizedMlp<S> small(network, format, inputs<S>(100, 3));
        const double error = double((outputs_of<S>(small, x) - expected).norm() / expected.norm());
        CHECK(error > last);  // fewer bytes, less exact
        CHECK(error < (format == WeightFormat::bfloat16 ? 0.005 : format == WeightFormat::int8 ? 0.008 : 0.05));
        last = error;
    }
}

TEST_CASE_TEMPLATE("a network of the rounded weights gives the same outputs", S, float, double) {
    const Mlp<S> network = trained_network<S>();
    const QuantizedMlp<S> small(network, WeightFormat::int8);
    Mlp<S> rounded = network;
    for (Index k = 0; k <= 3; ++k) {
        auto weight = rounded.weight(k);
        for (Index r = 0; r < weight.rows(); ++r) {
            for (Index c = 0; c < weight.cols(); ++c) {
                weight(r, c) = S(k < 3 ? std::get<0>(small.linear(k)).rows().value(r, c)
                                       : std::get<1>(small.linear(k)).rows().value(r, c));
            }
        }
    }
    const MatrixX<S> x = inputs<S>(5, 2);
    CHECK((outputs_of<S>(small, x) - outputs_of<S>(rounded, x)).cwiseAbs().maxCoeff() < S(1e-4));
}

TEST_CASE("each format stores each layer as it says") {
    const Mlp<float> network = trained_network<float>();
    const auto kinds = [&](WeightFormat format) {
        const QuantizedMlp<float> small(network, format, inputs<float>(50, 3));
        std::string result;
        for (Index k = 0; k <= 3; ++k) {
            result += std::to_string(small.linear(k).index());
        }
        return result;
    };
    CHECK(kinds(WeightFormat::bfloat16) == "0000");
    CHECK(kinds(WeightFormat::int8) == "0001");
    CHECK(kinds(WeightFormat::int4) == "0102");
}

TEST_CASE("threads change no bit") {
    const Mlp<float> network = trained_network<float>();
    const ThreadExecutor two(2), three(3);
    for (const WeightFormat format : small_formats) {
        const QuantizedMlp<float> small(network, format, inputs<float>(50, 3), three);
        const MatrixX<float> x = inputs<float>(4, 2), expected = outputs_of<float>(small, x);
        CHECK(outputs_of<float>(QuantizedMlp<float>(network, format, inputs<float>(50, 3)), x) == expected);
        auto scratch = small.make_scratch(4);
        MatrixX<float> y(700, 4);
        for (const ThreadExecutor* const executor : {&two, &three}) {
            small.infer_into(x, scratch, y, *executor);
            CHECK(y == expected);
        }
    }
}

TEST_CASE("a network without hidden layers") {
    Mlp<float> network({.inputs = 20, .hidden = {}, .outputs = 9});
    network.initialize(1);
    const MatrixX<float> x = inputs<float>(3, 2);
    for (const WeightFormat format : small_formats) {
        const MatrixX<float> y = outputs_of<float>(QuantizedMlp<float>(network, format, inputs<float>(30, 3)), x);
        CHECK((y - outputs_of<float>(network, x)).cwiseAbs().maxCoeff() < 0.3F);
    }
}

TEST_CASE("bytes are those of the formats") {
    Mlp<float> network({.inputs = 8, .hidden = {96}, .outputs = 8192});
    network.initialize(1);
    RandomGenerator random(1);
    const MatrixX<float> x = MatrixX<float>::NullaryExpr(8, 20, [&random] { return float(random.normal()); });
    const auto bytes = [&](WeightFormat format) { return double(QuantizedMlp<float>(network, format, x).num_bytes()); };
    const double last = 8192 * 96;
    CHECK(bytes(WeightFormat::bfloat16) < 2.15 * last);
    CHECK(bytes(WeightFormat::int8) < 1.15 * last);
    CHECK(bytes(WeightFormat::int4) < 0.82 * last);
}

TEST_CASE("what no quantized network can be made of is refused") {
    Mlp<float> network = trained_network<float>();
    const auto make = [&](WeightFormat format, const MatrixX<float>& typical = {}) {
        return refusal([&] { QuantizedMlp<float>(network, format, typical); });
    };
    CHECK(make(WeightFormat::full) ==
          "network: weights of the format full, expected one with fewer bytes than the trained ones");
    CHECK(make(WeightFormat::int4) == "network: 0 typical inputs, weights of the format int4 need at least 2");
    CHECK(make(WeightFormat::int4, MatrixX<float>::Zero(3, 4)) == "network: 3 inputs, expected 20");
    network.weight(1)(3, 30) = std::numeric_limits<float>::quiet_NaN();
    CHECK(make(WeightFormat::bfloat16) == "network: 3.weight: weight (3, 30) is nan, expected a finite number");
    const QuantizedMlp<float> small(trained_network<float>(), WeightFormat::int8);
    auto scratch = small.make_scratch(1);
    MatrixX<float> y(700, 1);
    CHECK(refusal([&] { small.infer_into(MatrixX<float>::Zero(3, 1), scratch, y); }) ==
          "network: 3 inputs, expected 20");
}
