// SPDX-License-Identifier: MIT
/// @file
/// A multilayer perceptron with its parameters.
///
/// What        Mlp: layers and one vector of parameters; inference, and value and gradient by reverse mode
///
///     Mlp<float> network({.inputs = 840, .hidden = {4096, 4096, 600}, .outputs = 477000});
///     network.initialize(1);
///     auto scratch = network.make_scratch(1);
///     network.infer_into(inputs, scratch, outputs);
///
/// Equation    hidden layers a(LayerNorm(W x + b)), a the activation; the last is W x + b
/// Shapes      inputs x batch, outputs x batch, one sample a column
/// Names       those of MlpLayers, which has the same functions for parameters that lie elsewhere
/// Refuses     what MlpLayers refuses
/// Source      Nolte et al. 2026, sec. 4.4; initial values: PyTorch's nn.Linear
/// Tests       tests/unit/nn/mlp_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/nn/mlp_layers.hpp>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S, Activation A = Gelu>
class Mlp {
public:
    using Scalar = S;
    using Layers = MlpLayers<S, A>;
    using Scratch = typename Layers::Scratch;
    using Tape = typename Layers::Tape;

    /// Weights of normalisations 1, all other parameters 0.
    explicit Mlp(MlpSizes sizes) : layers_(std::move(sizes)), parameters_(VectorX<S>::Zero(layers_.num_parameters())) {
        for (Index k = 0; k < layers_.num_hidden(); ++k) {
            layers_.norm_parameters(parameters_, k).head(layers_.norm(k).features()).setOnes();
        }
    }

    /// Weights and biases of linear layers uniform in +-1 / sqrt(inputs of the layer), those of the last one scaled.
    void initialize(std::uint64_t seed, S last_layer_scale = S(1)) {
        RandomGenerator random(seed);
        for (Index k = 0; k <= layers_.num_hidden(); ++k) {
            const double bound = 1 / std::sqrt(double(layers_.linear(k).inputs()));
            const S scale = k == layers_.num_hidden() ? last_layer_scale : S(1);
            for (S& parameter : layers_.linear_parameters(parameters_, k)) {
                parameter = scale * S(random.uniform(-bound, bound));
            }
        }
    }

    const Layers& layers() const { return layers_; }
    const MlpSizes& sizes() const { return layers_.sizes(); }
    const std::vector<ParameterTensor>& tensors() const { return layers_.tensors(); }

    VectorX<S>& parameters() { return parameters_; }
    const VectorX<S>& parameters() const { return parameters_; }

    /// Weight (outputs x inputs) and bias of linear layer `layer`, 0 .. layers().num_hidden().
    auto weight(Index layer) { return layers_.linear(layer).weight(layers_.linear_parameters(parameters_, layer)); }
    auto bias(Index layer) { return layers_.linear(layer).bias(layers_.linear_parameters(parameters_, layer)); }
    auto weight(Index layer) const {
        return layers_.linear(layer).const_weight(layers_.linear_parameters(parameters_, layer));
    }
    auto bias(Index layer) const {
        return layers_.linear(layer).const_bias(layers_.linear_parameters(parameters_, layer));
    }

    Scratch make_scratch(Index max_batch) const { return layers_.make_scratch(max_batch); }
    Tape make_tape(Index max_batch) const { return layers_.make_tape(max_batch); }

    template <Executor E = SequentialExecutor>
    void infer_into(ConstRef<MatrixX<S>> inputs, Scratch& scratch, Eigen::Ref<MatrixX<S>> outputs,
                    const E& executor = {}) const {
        layers_.infer_into(parameters_, inputs, scratch, outputs, executor);
    }

    template <Executor E = SequentialExecutor>
    void forward_into(ConstRef<MatrixX<S>> inputs, Tape& tape, Eigen::Ref<MatrixX<S>> outputs,
                      const E& executor = {}) const {
        layers_.forward_into(parameters_, inputs, tape, outputs, executor);
    }

    /// After forward_into() of the same inputs; `gradient` is laid out as parameters() and overwritten.
    template <Executor E = SequentialExecutor>
    void backward_into(ConstRef<MatrixX<S>> inputs, Tape& tape, ConstRef<MatrixX<S>> output_gradients,
                       VectorX<S>& gradient, const E& executor = {}) const {
        gradient.resize(parameters_.size());
        layers_.backward_into(parameters_, inputs, tape, output_gradients, gradient, executor);
    }

    /// After backward_into() with the same output gradients.
    template <Executor E = SequentialExecutor>
    void input_gradients_into(Tape& tape, ConstRef<MatrixX<S>> output_gradients, Eigen::Ref<MatrixX<S>> input_gradients,
                              const E& executor = {}) const {
        layers_.input_gradients_into(parameters_, tape, output_gradients, input_gradients, executor);
    }

private:
    Layers layers_;
    VectorX<S> parameters_;
};

}  // namespace softtissue
