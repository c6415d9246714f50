// SPDX-License-Identifier: MIT
#include <softtissue/nn/network_inference.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("outputs are those of the network, or of the one that takes its place", S, float, double) {
    Mlp<S> network({.inputs = 9, .hidden = {12}, .outputs = 30});
    network.initialize(1);
    const QuantizedMlp<S> small(network, WeightFormat::int8);
    const MatrixX<S> x = MatrixX<S>::NullaryExpr(9, 2, [](Index i, Index j) { return S(i + 2 * j); });
    MatrixX<S> y(30, 2), expected(30, 2);
    auto scratch = network.make_scratch(2);
    network.infer_into(x, scratch, expected);
    NetworkInference<S>(network, nullptr, 2).infer_into(x, y);
    CHECK(y == expected);
    auto small_scratch = small.make_scratch(2);
    small.infer_into(x, small_scratch, expected);
    NetworkInference<S> inference(network, &small, 2);
    inference.infer_into(x, y);
    CHECK(y == expected);
    CHECK(inference.sizes().outputs == 30);
}

TEST_CASE("weights of another network are refused") {
    Mlp<float> network({.inputs = 9, .hidden = {12}, .outputs = 30}),
        other({.inputs = 9, .hidden = {13}, .outputs = 30});
    const QuantizedMlp<float> small(other, WeightFormat::int8);
    CHECK(softtissue_test::refusal([&] { NetworkInference<float>(network, &small); }) ==
          "network: quantized weights of 9 inputs, 1 hidden layers and 30 outputs, expected those of a network of 9, 1 "
          "and "
          "30");
}
