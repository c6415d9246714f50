// SPDX-License-Identifier: MIT
#include <softtissue/nn/principal_linear.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

constexpr Index depth = 32, rows = 600;

/// Inputs that vary a thousand times more in some directions than in others, far from zero.
template <class S>
MatrixX<S> inputs_like_hidden_layers(Index samples, std::uint64_t seed) {
    RandomGenerator directions(9), random(seed);
    MatrixX<S> x = MatrixX<S>::Constant(depth, samples, S(0.3));
    for (Index d = 0; d < depth; ++d) {
        VectorX<S> direction(depth);
        for (S& entry : direction) {
            entry = S(directions.uniform(-1, 1));
        }
        const S size = std::pow(S(10), -S(d) / S(10));
        for (Index k = 0; k < samples; ++k) {
            x.col(k) += size * S(random.uniform(-1, 1)) * direction;
        }
    }
    return x;
}

template <class S>
struct Trained {
    typename Linear<S>::WeightMatrix weight{rows, depth};
    VectorX<S> bias = VectorX<S>::Constant(rows, S(0.1));

    Trained() {
        RandomGenerator random(1);
        for (S& w : weight.reshaped()) {
            w = S(random.uniform(-1, 1));
        }
    }

    MatrixX<S> value(const MatrixX<S>& x) const {
        MatrixX<S> y = bias.replicate(1, x.cols());
        add_batch_product<S>(weight.data(), x, y);
        return y;
    }
};

template <class Layer, class S>
double error_of(const Layer& layer, const Trained<S>& trained, const MatrixX<S>& x) {
    typename Layer::Scratch scratch;
    layer.reserve(scratch, x.cols());
    MatrixX<S> y(rows, x.cols());
    layer.forward_into(x, scratch, y);
    return double((y - trained.value(x)).norm()) / std::sqrt(double(y.size()));
}

}  // namespace

TEST_CASE_TEMPLATE("inputs like the typical ones suffer far less than by rounding the weights as they are", S, float,
                   double) {
    const Trained<S> trained;
    const PrincipalLinear<S> layer(trained.weight, trained.bias, inputs_like_hidden_layers<S>(100, 2), "layer");
    const QuantizedLinear<S, Int4Weights> plain(trained.weight, trained.bias, "layer");
    const MatrixX<S> x = inputs_like_hidden_layers<S>(50, 3);
    CHECK(layer.num_leading() == 8);
    CHECK(error_of(layer, trained, x) < 0.25 * error_of(plain, trained, x));
    CHECK(error_of(layer, trained, MatrixX<S>(x.rowwise().mean())) < 0.5 * error_of(layer, trained, x));
}

TEST_CASE_TEMPLATE("any other inputs are served within the rounding of half bytes", S, float, double) {
    const Trained<S> trained;
    // fewer typical inputs than leading directions
    const PrincipalLinear<S> layer(trained.weight, trained.bias, inputs_like_hidden_layers<S>(4, 2), "layer");
    RandomGenerator random(4);
    const MatrixX<S> x = MatrixX<S>::NullaryExpr(depth, 20, [&] { return S(random.uniform(-10, 10)); });
    const MatrixX<S> expected = trained.value(x);
    CHECK(error_of(layer, trained, x) < 0.15 * double(expected.norm()) / std::sqrt(double(expected.size())));
    CHECK(error_of(layer, trained, x) > 0.0);
}

TEST_CASE("layers of few inputs") {
    const Trained<float> trained;
    const MatrixX<float> x = inputs_like_hidden_layers<float>(20, 2);
    for (const Index inputs : {2, 3, 8, 9, 10, 17}) {
        const Linear<float>::WeightMatrix weight = trained.weight.leftCols(inputs);
        const PrincipalLinear<float> layer(weight, trained.bias, x.topRows(inputs), "layer");
        CHECK(layer.num_leading() >= 1);
        CHECK(layer.num_leading() < inputs);
        PrincipalLinear<float>::Scratch scratch;
        layer.reserve(scratch, 20);
        MatrixX<float> y(rows, 20), expected = trained.bias.replicate(1, 20);
        layer.forward_into(x.topRows(inputs), scratch, y);
        const MatrixX<float> few = x.topRows(inputs);
        add_batch_product<float>(weight.data(), few, expected);
        CHECK((y - expected).norm() < 0.1F * expected.norm());
    }
}

TEST_CASE("threads change no bit") {
    const Trained<float> trained;
    const MatrixX<float> x = inputs_like_hidden_layers<float>(5, 3);
    const auto result = [&](const auto& executor) {
        const PrincipalLinear<float> layer(trained.weight, trained.bias, inputs_like_hidden_layers<float>(40, 2),
                                           "layer", executor);
        PrincipalLinear<float>::Scratch scratch;
        layer.reserve(scratch, 5);
        MatrixX<float> y(rows, 5);
        layer.forward_into(x, scratch, y, executor);
        return y;
    };
    const MatrixX<float> expected = result(SequentialExecutor{});
    CHECK(result(ThreadExecutor(2)) == expected);
    CHECK(result(ThreadExecutor(3)) == expected);
}

TEST_CASE("few or equal typical inputs and weights that are not finite are refused") {
    Trained<float> trained;
    const MatrixX<float> typical = inputs_like_hidden_layers<float>(5, 2);
    const auto make = [&](const MatrixX<float>& inputs) {
        return refusal([&] { PrincipalLinear<float>(trained.weight, trained.bias, inputs, "network: 3.weight"); });
    };
    CHECK(make(typical).empty());
    CHECK(make(typical.topRows(3)) == "network: 3.weight: typical inputs of 3 numbers, expected 32");
    CHECK(make(MatrixX<float>::Ones(depth, 3)) ==
          "network: 3.weight: 3 typical inputs, expected at least two that differ");
    CHECK(make(typical.leftCols(1)) == "network: 3.weight: 1 typical inputs, expected at least two that differ");
    CHECK(refusal([&] { PrincipalLinear<float>(trained.weight.leftCols(1), trained.bias, typical.topRows(1), "w"); }) ==
          "w: 1 inputs, expected at least 2");
    trained.weight(3, 4) = std::numeric_limits<float>::quiet_NaN();
    CHECK(make(typical) == "network: 3.weight: weight (3, 4) is nan, expected a finite number");
}
