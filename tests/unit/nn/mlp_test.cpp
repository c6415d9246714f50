// SPDX-License-Identifier: MIT
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

#include <support/allocation_counter.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;

TEST_CASE_TEMPLATE("a new network has normalisations of weight one and nothing else", S, float, double) {
    Mlp<S> network({2, {3}, 4});
    CHECK(network.parameters().sum() == S(3));
    CHECK(network.parameters().segment(9, 3) == VectorX<S>::Ones(3));
    const MatrixX<S> x = MatrixX<S>::Constant(2, 1, S(2));
    auto scratch = network.make_scratch(1);
    MatrixX<S> y(4, 1);
    network.bias(1)(2) = S(7);
    network.infer_into(x, scratch, y);
    CHECK(y == (MatrixX<S>(4, 1) << S(0), S(0), S(7), S(0)).finished());
}

TEST_CASE_TEMPLATE("initial values are uniform within the bound of each layer", S, float, double) {
    Mlp<S> network({25, {100, 64}, 200});
    network.initialize(3, S(0.1));
    const Index widths[] = {25, 100, 64};
    for (Index k = 0; k < 3; ++k) {
        const double bound = (k == 2 ? 0.1 : 1) / std::sqrt(double(widths[k]));
        const VectorX<double> weights = network.weight(k).reshaped().template cast<double>();
        CHECK(weights.cwiseAbs().maxCoeff() <= bound * 1.000001);
        CHECK(weights.cwiseAbs().maxCoeff() >= 0.99 * bound);
        CHECK(std::abs(weights.mean()) <= 0.05 * bound);
        CHECK(weights.squaredNorm() / double(weights.size()) == doctest::Approx(bound * bound / 3).epsilon(0.05));
        CHECK(network.bias(k).cwiseAbs().maxCoeff() > S(0));
    }
    Mlp<S> again({25, {100, 64}, 200}), other = again;
    again.initialize(3, S(0.1));
    other.initialize(4, S(0.1));
    CHECK(again.parameters() == network.parameters());
    CHECK(other.parameters() != network.parameters());
    CHECK(network.layers().norm_parameters(network.parameters(), 1)(0) == S(1));
}

TEST_CASE_TEMPLATE("the functions are those of the layers with the network's parameters", S, float, double) {
    Mlp<S> network({5, {8}, 6});
    network.initialize(1);
    const MatrixX<S> x = MatrixX<S>::Constant(5, 2, S(0.3)), dy = MatrixX<S>::Constant(6, 2, S(-0.7));
    const auto& layers = network.layers();
    const VectorX<S>& parameters = network.parameters();
    MatrixX<S> y(6, 2), expected_y(6, 2), inferred(6, 2), dx(5, 2), expected_dx(5, 2);
    VectorX<S> gradient, expected_gradient(layers.num_parameters());
    auto tape = network.make_tape(2);
    auto scratch = network.make_scratch(2);
    layers.forward_into(parameters, x, tape, expected_y);
    layers.backward_into(parameters, x, tape, dy, expected_gradient);
    layers.input_gradients_into(parameters, tape, dy, expected_dx);
    network.infer_into(x, scratch, inferred);
    network.forward_into(x, tape, y);
    network.backward_into(x, tape, dy, gradient);
    network.input_gradients_into(tape, dy, dx);
    CHECK(y == expected_y);
    CHECK(inferred == expected_y);
    CHECK(gradient == expected_gradient);
    CHECK(dx == expected_dx);
}

TEST_CASE_TEMPLATE("inference allocates nothing, of one sample, of a few and of many", S, float, double) {
    Mlp<S> network({50, {300, 20}, 1500});
    network.initialize(1);
    for (const Index batch : {1, 2, 8, 9, 150}) {
        const MatrixX<S> x = MatrixX<S>::Constant(50, batch, S(0.3));
        auto scratch = network.make_scratch(batch);
        MatrixX<S> y(1500, batch);
        const softtissue_test::AllocationCounter counter;
        network.infer_into(x, scratch, y);
        CHECK(counter.count() == 0);
    }
}

TEST_CASE("nor with weights in fewer bytes") {
    Mlp<float> network({50, {300, 20}, 1500});
    network.initialize(1);
    const MatrixX<float> typical =
        MatrixX<float>::NullaryExpr(50, 9, [](Index i, Index j) { return float(i * j % 7); });
    for (const WeightFormat format : {WeightFormat::bfloat16, WeightFormat::int8, WeightFormat::int4}) {
        const QuantizedMlp<float> small(network, format, typical);
        auto scratch = small.make_scratch(8);
        for (const Index batch : {1, 2, 8}) {
            MatrixX<float> y(1500, batch);
            const softtissue_test::AllocationCounter counter;
            small.infer_into(typical.leftCols(batch), scratch, y);
            CHECK(counter.count() == 0);
        }
    }
}
