// SPDX-License-Identifier: MIT
/// @file
/// A trained multilayer perceptron with its weights in few bytes, for inference.
///
/// What        QuantizedMlp: the outputs of a batch, of weights in one of the formats of weight_format.hpp
///
///     const QuantizedMlp<float> small(network, WeightFormat::int8);
///     auto scratch = small.make_scratch(1);
///     small.infer_into(inputs, scratch, outputs);
///
/// Equation    that of MlpLayers with rounded weights; products with bytes take the layer's input in whole numbers of
///             sixteen bits. Biases, normalisations and activations as they are.
/// Shapes      inputs x batch, outputs x batch, one sample a column
/// Refuses     WeightFormat::full, which Mlp serves; int4 without typical inputs; what the layers refuse, naming the tensor
///             ("3.weight"); arrays of other sizes (InvalidInput)
/// Threads     same bits for every executor
/// Cost        bytes of the weights, read once for up to four samples. infer_into() allocates nothing. int4 takes one product
///             of the last layer's weights with a square matrix to make.
/// Tests       tests/unit/nn/quantized_mlp_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/bfloat16_weights.hpp>
#include <softtissue/nn/int8_weights.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/principal_linear.hpp>
#include <softtissue/nn/quantized_linear.hpp>
#include <softtissue/nn/weight_format.hpp>

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace softtissue {

template <RealScalar S, Activation A = Gelu>
class QuantizedMlp {
public:
    using Scalar = S;
    using Layer =
        std::variant<QuantizedLinear<S, BFloat16Weights>, QuantizedLinear<S, Int8Weights>, PrincipalLinear<S>>;

    /// What inference writes to; one for each thread that infers.
    struct Scratch {
        typename MlpLayers<S, A>::Scratch layers;
        FloatColumns floats;
        DigitColumns digits;
        typename PrincipalLinear<S>::Scratch principal;
    };

    /// `typical_inputs`, inputs x samples, tell int4 in which directions the last layer's input varies.
    template <Executor E = SequentialExecutor>
    QuantizedMlp(const Mlp<S, A>& mlp, WeightFormat format, const MatrixX<S>& typical_inputs = {},
                 const E& executor = {})
        : layers_(mlp.sizes()) {
        require(format != WeightFormat::full, "network: weights of the format ", to_string(format),
                ", expected one with fewer bytes than the trained ones");
        const Index last = layers_.num_hidden();
        for (Index k = 0; k < last; ++k) {
            const bool is_between = k > 0 && k + 1 < last;
            add_layer(mlp, k, format == WeightFormat::int4 && is_between ? WeightFormat::int8 : WeightFormat::bfloat16,
                      typical_inputs, executor);
            norm_parameters_.emplace_back(layers_.norm_parameters(mlp.parameters(), k));
        }
        add_layer(mlp, last, format, typical_inputs, executor);
    }

    const MlpSizes& sizes() const { return layers_.sizes(); }
    /// Layer sizes().hidden.size() is the last.
    const Layer& linear(Index layer) const { return linear_[size_t(layer)]; }

    std::size_t num_bytes() const {
        std::size_t bytes = 0;
        for (const Layer& layer : linear_) {
            bytes += std::visit([](const auto& stored) { return stored.num_bytes(); }, layer);
        }
        for (const VectorX<S>& parameters : norm_parameters_) {
            bytes += sizeof(S) * size_t(parameters.size());
        }
        return bytes;
    }

    Scratch make_scratch(Index max_batch) const {
        Scratch scratch{layers_.make_scratch(max_batch), {}, {}, {}};
        for (const Layer& layer : linear_) {
            std::visit([&](const auto& stored) { stored.reserve(scratch_of(stored, scratch), max_batch); }, layer);
        }
        return scratch;
    }

    /// The outputs of at most as many samples as the scratch was made for.
    template <Executor E = SequentialExecutor>
    void infer_into(ConstRef<MatrixX<S>> inputs, Scratch& scratch, Eigen::Ref<MatrixX<S>> outputs,
                    const E& executor = {}) const {
        layers_.infer_by(
            inputs, scratch.layers, outputs,
            [&](Index layer, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y) {
                std::visit(
                    [&](const auto& stored) { stored.forward_into(x, scratch_of(stored, scratch), y, executor); },
                    linear(layer));
            },
            [&](Index layer) -> const VectorX<S>& { return norm_parameters_[size_t(layer)]; });
    }

private:
    static FloatColumns& scratch_of(const QuantizedLinear<S, BFloat16Weights>&, Scratch& scratch) {
        return scratch.floats;
    }
    static DigitColumns& scratch_of(const QuantizedLinear<S, Int8Weights>&, Scratch& scratch) { return scratch.digits; }
    static typename PrincipalLinear<S>::Scratch& scratch_of(const PrincipalLinear<S>&, Scratch& scratch) {
        return scratch.principal;
    }

    static std::string name(Index layer) { return "network: " + std::to_string(3 * layer) + ".weight"; }

    template <class E>
    void add_layer(const Mlp<S, A>& mlp, Index layer, WeightFormat format, const MatrixX<S>& typical_inputs,
                   const E& executor) {
        const auto weight = mlp.weight(layer);
        const auto bias = mlp.bias(layer);
        if (format == WeightFormat::bfloat16) {
            linear_.emplace_back(QuantizedLinear<S, BFloat16Weights>(weight, bias, name(layer), executor));
        } else if (format == WeightFormat::int8) {
            linear_.emplace_back(QuantizedLinear<S, Int8Weights>(weight, bias, name(layer), executor));
        } else {
            require(typical_inputs.cols() >= 2, "network: ", typical_inputs.cols(),
                    " typical inputs, weights of the format int4 need at least 2");
            linear_.emplace_back(
                PrincipalLinear<S>(weight, bias, last_inputs(mlp, typical_inputs, executor), name(layer), executor));
        }
    }

    /// The typical inputs of the last layer.
    template <class E>
    static MatrixX<S> last_inputs(const Mlp<S, A>& mlp, const MatrixX<S>& inputs, const E& executor) {
        const MlpLayers<S, A>& layers = mlp.layers();
        auto scratch = layers.make_scratch(inputs.cols());
        return layers.last_inputs_by(
            inputs, scratch,
            [&](Index layer, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y) {
                layers.linear(layer).forward_into(layers.linear_parameters(mlp.parameters(), layer), x, y, executor);
            },
            [&](Index layer) { return layers.norm_parameters(mlp.parameters(), layer); });
    }

    MlpLayers<S, A> layers_;
    std::vector<Layer> linear_;
    std::vector<VectorX<S>> norm_parameters_;
};

}  // namespace softtissue
