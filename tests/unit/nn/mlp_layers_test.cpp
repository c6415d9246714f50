// SPDX-License-Identifier: MIT
#include <softtissue/nn/mlp_layers.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index columns, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(rows, columns, [&random] { return S(random.uniform(-1, 1)); });
}

/// The network layer by layer with plain loops, in double.
template <class S, class A>
MatrixX<double> naive_outputs(const MlpLayers<S, A>& layers, const VectorX<S>& parameters, const MatrixX<S>& inputs) {
    const auto at = [&](const ParameterTensor& tensor, Index i) { return double(parameters(tensor.offset + i)); };
    MatrixX<double> x = inputs.template cast<double>();
    for (size_t t = 0; t < layers.tensors().size(); t += 4) {
        const ParameterTensor& weight = layers.tensors()[t];
        MatrixX<double> y(weight.shape[0], x.cols());
        for (Index r = 0; r < y.rows(); ++r) {
            for (Index sample = 0; sample < y.cols(); ++sample) {
                y(r, sample) = at(layers.tensors()[t + 1], r);
                for (Index c = 0; c < x.rows(); ++c) {
                    y(r, sample) += at(weight, r * x.rows() + c) * x(c, sample);
                }
            }
        }
        if (t + 2 == layers.tensors().size()) {
            return y;
        }
        for (Index sample = 0; sample < y.cols(); ++sample) {
            const double mean = y.col(sample).mean();
            const double variance = (y.col(sample).array() - mean).square().mean();
            for (Index r = 0; r < y.rows(); ++r) {
                const double n = (y(r, sample) - mean) / std::sqrt(variance + 1e-5);
                y(r, sample) = A::at(at(layers.tensors()[t + 2], r) * n + at(layers.tensors()[t + 3], r)).value;
            }
        }
        x = y;
    }
    return x;
}

const std::vector<MlpSizes> shapes = {{3, {}, 4}, {5, {7}, 3}, {9, {20, 6}, 300}, {4, {17, 33, 5}, 12}};

}  // namespace

TEST_CASE_TEMPLATE("inference and the forward pass give what plain loops give", A, Gelu, TanhGelu) {
    const auto check = [](auto epsilon) {
        using S = decltype(epsilon);
        for (const MlpSizes& sizes : shapes) {
            const MlpLayers<S, A> layers(sizes);
            const VectorX<S> parameters = random_matrix<S>(layers.num_parameters(), 1, 1);
            auto scratch = layers.make_scratch(6);
            auto tape = layers.make_tape(6);
            for (const Index batch : {6, 1, 4}) {
                const MatrixX<S> x = random_matrix<S>(sizes.inputs, batch, 2);
                const MatrixX<double> expected = naive_outputs(layers, parameters, x);
                MatrixX<S> inferred(sizes.outputs, batch), y(sizes.outputs, batch);
                layers.infer_into(parameters, x, scratch, inferred);
                layers.forward_into(parameters, x, tape, y);
                CHECK(inferred == y);
                const double tolerance = 100 * double(epsilon);
                CHECK((y.template cast<double>() - expected).cwiseAbs().maxCoeff() <= tolerance);
            }
        }
    };
    check(std::numeric_limits<float>::epsilon());
    check(std::numeric_limits<double>::epsilon());
}

TEST_CASE_TEMPLATE("gradients by parameters and by inputs", A, Gelu, TanhGelu) {
    for (const MlpSizes& sizes : shapes) {
        const MlpLayers<double, A> layers(sizes);
        const VectorX<double> parameters = random_matrix<double>(layers.num_parameters(), 1, 1);
        const VectorX<double> dp = 0.3 * random_matrix<double>(layers.num_parameters(), 1, 2);
        for (const Index batch : {1, 5}) {
            const MatrixX<double> x = random_matrix<double>(sizes.inputs, batch, 3);
            const MatrixX<double> dx = 0.3 * random_matrix<double>(sizes.inputs, batch, 4);
            const MatrixX<double> dy = random_matrix<double>(sizes.outputs, batch, 5);
            auto scratch = layers.make_scratch(batch);
            auto tape = layers.make_tape(7);
            MatrixX<double> y(sizes.outputs, batch), input_gradients(sizes.inputs, batch);
            VectorX<double> gradient(layers.num_parameters());
            const auto along = [&](double h) {
                const VectorX<double> moved = parameters + h * dp;
                layers.infer_into(moved, x + h * dx, scratch, y);
                return y.cwiseProduct(dy).sum();
            };
            layers.forward_into(parameters, x, tape, y);
            layers.backward_into(parameters, x, tape, dy, gradient);
            layers.input_gradients_into(parameters, tape, dy, input_gradients);
            const double slope = gradient.dot(dp) + input_gradients.cwiseProduct(dx).sum();
            CHECK(taylor_rate(along, slope).is_at_least(2));
            CHECK(!taylor_rate(along, slope * 1.001).is_at_least(2));
        }
    }
}

TEST_CASE_TEMPLATE("same bits for any number of threads", S, float, double) {
    const MlpLayers<S> layers({19, {300, 40}, 1500});
    const VectorX<S> parameters = random_matrix<S>(layers.num_parameters(), 1, 1);
    const MatrixX<S> x = random_matrix<S>(19, 5, 2), dy = random_matrix<S>(1500, 5, 3);
    const auto results = [&](const auto& executor) {
        auto tape = layers.make_tape(5);
        auto scratch = layers.make_scratch(5);
        MatrixX<S> y(1500, 5), inferred(1500, 5), dx(19, 5);
        VectorX<S> gradient(layers.num_parameters());
        layers.infer_into(parameters, x, scratch, inferred, executor);
        layers.forward_into(parameters, x, tape, y, executor);
        layers.backward_into(parameters, x, tape, dy, gradient, executor);
        layers.input_gradients_into(parameters, tape, dy, dx, executor);
        return std::vector<MatrixX<S>>{inferred, y, gradient, dx};
    };
    const std::vector<MatrixX<S>> expected = results(SequentialExecutor{});
    for (const int threads : {2, 7}) {
        CHECK(results(ThreadExecutor(threads)) == expected);
    }
}

TEST_CASE("tensors are named and laid out as PyTorch's") {
    const MlpLayers<float> layers({2, {3, 4}, 5});
    std::string names;
    Index end = 0;
    for (const ParameterTensor& tensor : layers.tensors()) {
        names += tensor.name + " ";
        CHECK(tensor.offset == end);
        end += tensor.size();
    }
    CHECK(names == "0.weight 0.bias 1.weight 1.bias 3.weight 3.bias 4.weight 4.bias 6.weight 6.bias ");
    CHECK(layers.tensors()[4].shape == std::vector<Index>{4, 3});
    CHECK(end == layers.num_parameters());
    CHECK(end == 3 * 3 + 6 + 4 * 4 + 8 + 5 * 5);
}

TEST_CASE("arguments of another size are refused") {
    const MlpLayers<double> layers({2, {3}, 4});
    const VectorX<double> parameters = random_matrix<double>(layers.num_parameters(), 1, 1);
    auto scratch = layers.make_scratch(2);
    auto tape = layers.make_tape(2);
    const MatrixX<double> x(2, 1), wide(2, 3);
    MatrixX<double> y(4, 1), wide_y(4, 3), short_y(3, 1);
    VectorX<double> gradient(layers.num_parameters());
    const auto infer = [&](const MatrixX<double>& inputs, MatrixX<double>& outputs) {
        layers.infer_into(parameters, inputs, scratch, outputs);
    };
    CHECK_THROWS_WITH_AS(infer(y, y), "network: 4 inputs, expected 2", InvalidInput);
    CHECK_THROWS_WITH_AS(infer(x, short_y), "network: outputs 3 x 1, expected 4 x 1", InvalidInput);
    CHECK_THROWS_WITH_AS(infer(wide, wide_y), "network: batch of 3, expected 1 to 2", InvalidInput);
    CHECK_THROWS_WITH_AS(layers.infer_into(gradient.head(3), x, scratch, y), "network: 3 parameters, expected 31",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(layers.backward_into(parameters, x, tape, y, gradient),
                         "gradient of a network: 1 samples, expected the 0 of the last forward_into()", InvalidInput);
    layers.forward_into(parameters, x, tape, y);
    CHECK_THROWS_WITH_AS(layers.backward_into(parameters, x, tape, y, gradient.head(5)),
                         "gradient of a network: 5 entries, expected 31", InvalidInput);
    CHECK_THROWS_AS(MlpLayers<double>({2, {0}, 4}), InvalidInput);
}
