// SPDX-License-Identifier: MIT
/// @file
/// The layers of a multilayer perceptron, its parameters lying with the caller.
///
/// What        value of a batch with as little memory as possible (infer_into), and value and gradient by reverse mode
///             (forward_into, backward_into); parameters are one vector, for an optimiser that knows no layers
/// Equation    hidden layers a(LayerNorm(W x + b)), a the activation; the last is W x + b
/// Shapes      inputs x batch, outputs x batch, one sample a column: PyTorch's (batch, inputs) array binds without a copy
/// Names       those of PyTorch's Sequential(Linear, LayerNorm, GELU, Linear, ...): "0.weight", "0.bias", "1.weight", ...
/// Threads     same bits for every executor
/// Refuses     sizes below one; parameters, inputs, outputs and gradients of other sizes (InvalidInput)
/// Source      Nolte et al. 2026, sec. 4.4
/// Cost        that of the linear layers: 2 flop a weight and sample, three times that with gradients. infer_into()
///             allocates nothing.
/// Tests       tests/unit/nn/mlp_layers_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/nn/concepts.hpp>
#include <softtissue/nn/gelu.hpp>
#include <softtissue/nn/layer_norm.hpp>
#include <softtissue/nn/linear.hpp>
#include <softtissue/nn/parameter_tensor.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

struct MlpSizes {
    Index inputs = 0;
    std::vector<Index> hidden;  ///< may be empty: one linear layer
    Index outputs = 0;
};

template <RealScalar S, Activation A = Gelu>
class MlpLayers {
public:
    using Scalar = S;

    /// What inference writes to; one for each thread that infers.
    struct Scratch {
        MatrixX<S> even, odd;  ///< outputs of hidden layers 0, 2, .. and 1, 3, ..
        VectorX<S> deviations;
    };

    /// What forward_into() keeps for backward_into().
    struct Tape {
        /// Of one hidden layer.
        struct Hidden {
            MatrixX<S> normalized, slopes, outputs, gradients;
            VectorX<S> inverse_deviations;
        };
        std::vector<Hidden> hidden;
        MatrixX<S> parts;  ///< of Linear::input_gradient_into()
        Index max_batch = 0;
        Index batch = 0;  ///< of the last forward_into()
    };

    explicit MlpLayers(MlpSizes sizes) : sizes_(std::move(sizes)) {
        Index width = sizes_.inputs;
        for (const Index next : sizes_.hidden) {
            linear_.emplace_back(width, next);
            norm_.emplace_back(next);
            width = next;
        }
        linear_.emplace_back(width, sizes_.outputs);
        name_tensors();
    }

    const MlpSizes& sizes() const { return sizes_; }
    Index num_parameters() const { return num_parameters_; }
    const std::vector<ParameterTensor>& tensors() const { return tensors_; }

    Index num_hidden() const { return Index(norm_.size()); }
    /// Layer num_hidden() is the last.
    const Linear<S>& linear(Index layer) const { return linear_[size_t(layer)]; }
    const LayerNorm<S>& norm(Index layer) const { return norm_[size_t(layer)]; }

    /// The segment of a vector of parameters, or of their gradient, that belongs to one layer.
    template <class Vector>
    auto linear_parameters(Vector& all, Index layer) const {
        return all.segment(offsets_[size_t(2 * layer)], linear(layer).num_parameters());
    }
    template <class Vector>
    auto norm_parameters(Vector& all, Index layer) const {
        return all.segment(offsets_[size_t(2 * layer + 1)], norm(layer).num_parameters());
    }

    Scratch make_scratch(Index max_batch) const {
        Index even = 0, odd = 0;
        for (Index k = 0; k < num_hidden(); ++k) {
            Index& widest = k % 2 == 0 ? even : odd;
            widest = std::max(widest, norm(k).features());
        }
        return {MatrixX<S>(even, max_batch), MatrixX<S>(odd, max_batch), VectorX<S>(max_batch)};
    }

    Tape make_tape(Index max_batch) const {
        Tape tape;
        tape.max_batch = max_batch;
        Index part_columns = 0, widest = 0;
        for (Index k = 0; k < num_hidden(); ++k) {
            const MatrixX<S> like(norm(k).features(), max_batch);
            tape.hidden.push_back({like, like, like, like, VectorX<S>(max_batch)});
        }
        for (const Linear<S>& layer : linear_) {
            part_columns = std::max(part_columns, layer.num_part_columns(max_batch));
            widest = std::max(widest, layer.inputs());
        }
        tape.parts.resize(widest, part_columns);
        return tape;
    }

    /// The outputs of at most as many samples as the scratch was made for.
    template <Executor E = SequentialExecutor>
    void infer_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> inputs, Scratch& scratch,
                    Eigen::Ref<MatrixX<S>> outputs, const E& executor = {}) const {
        require_parameters(parameters.size());
        infer_by(
            inputs, scratch, outputs,
            [&](Index k, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> y) {
                linear(k).forward_into(linear_parameters(parameters, k), x, y, executor);
            },
            [&](Index k) { return norm_parameters(parameters, k); });
    }

    /// The same with the linear layers as forward(layer, x, y), whatever form their weights have, and the parameters of
    /// normalisations as norm_parameters_of(layer).
    template <class Forward, class NormParameters>
    void infer_by(ConstRef<MatrixX<S>> inputs, Scratch& scratch, Eigen::Ref<MatrixX<S>> outputs, const Forward& forward,
                  const NormParameters& norm_parameters_of) const {
        require_outputs(inputs, outputs);
        forward(num_hidden(), last_inputs_by(inputs, scratch, forward, norm_parameters_of), outputs);
    }

    /// What the last linear layer is given; lies in the scratch, or is `inputs` if there are no hidden layers.
    template <class Forward, class NormParameters>
    Eigen::Ref<const MatrixX<S>> last_inputs_by(ConstRef<MatrixX<S>> inputs, Scratch& scratch, const Forward& forward,
                                                const NormParameters& norm_parameters_of) const {
        require_inputs(inputs, scratch.deviations.size());
        const Index batch = inputs.cols();
        const auto output_of = [&](Index k) -> Eigen::Ref<MatrixX<S>> {
            return (k % 2 == 0 ? scratch.even : scratch.odd).topLeftCorner(norm(k).features(), batch);
        };
        const auto input_of = [&](Index k) -> Eigen::Ref<const MatrixX<S>> {
            if (k == 0) {
                return inputs;
            }
            return output_of(k - 1);
        };
        for (Index k = 0; k < num_hidden(); ++k) {
            Eigen::Ref<MatrixX<S>> y = output_of(k);
            forward(k, input_of(k), y);
            norm(k).forward_into(norm_parameters_of(k), y, y, scratch.deviations.head(batch), y);
            for (Index sample = 0; sample < batch; ++sample) {
                activate(y.col(sample).data(), y.rows());
            }
        }
        return input_of(num_hidden());
    }

    /// The outputs, and what backward_into() needs, of at most as many samples as the tape was made for.
    template <Executor E = SequentialExecutor>
    void forward_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> inputs, Tape& tape,
                      Eigen::Ref<MatrixX<S>> outputs, const E& executor = {}) const {
        require_sizes(parameters.size(), inputs, outputs, tape.max_batch);
        const Index batch = tape.batch = inputs.cols();
        for (Index k = 0; k < num_hidden(); ++k) {
            typename Tape::Hidden& hidden = tape.hidden[size_t(k)];
            Eigen::Ref<MatrixX<S>> y = hidden.outputs.leftCols(batch);
            linear(k).forward_into(linear_parameters(parameters, k), input_of(k, inputs, tape), y, executor);
            norm(k).forward_into(norm_parameters(parameters, k), y, hidden.normalized.leftCols(batch),
                                 hidden.inverse_deviations.head(batch), y);
            activate(y.data(), hidden.slopes.data(), y.size());
        }
        const Index last = num_hidden();
        linear(last).forward_into(linear_parameters(parameters, last), input_of(last, inputs, tape), outputs, executor);
    }

    /// After forward_into() of the same parameters and inputs: the gradient by the parameters, of a function whose
    /// gradient by the outputs is given, summed over the batch. Overwrites.
    template <Executor E = SequentialExecutor>
    void backward_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> inputs, Tape& tape,
                       ConstRef<MatrixX<S>> output_gradients, Eigen::Ref<VectorX<S>> gradient,
                       const E& executor = {}) const {
        require_sizes(parameters.size(), inputs, output_gradients, tape.max_batch);
        require(inputs.cols() == tape.batch, "gradient of a network: ", inputs.cols(), " samples, expected the ",
                tape.batch, " of the last forward_into()");
        require(gradient.size() == num_parameters_, "gradient of a network: ", gradient.size(), " entries, expected ",
                num_parameters_);
        for (Index k = num_hidden(); k >= 0; --k) {
            const Eigen::Ref<const MatrixX<S>> dy = gradients_of(k, output_gradients, tape);
            linear(k).gradient_into(input_of(k, inputs, tape), dy, linear_parameters(gradient, k), executor);
            if (k == 0) {
                return;
            }
            typename Tape::Hidden& below = tape.hidden[size_t(k - 1)];
            Eigen::Ref<MatrixX<S>> d = below.gradients.leftCols(tape.batch);
            linear(k).input_gradient_into(linear_parameters(parameters, k), dy, tape.parts.topRows(linear(k).inputs()),
                                          d, executor);
            d.array() *= below.slopes.leftCols(tape.batch).array();
            norm(k - 1).backward_into(norm_parameters(parameters, k - 1), below.normalized.leftCols(tape.batch),
                                      below.inverse_deviations.head(tape.batch), d, norm_parameters(gradient, k - 1));
        }
    }

    /// After backward_into() with the same arguments: the gradient by the inputs.
    template <Executor E = SequentialExecutor>
    void input_gradients_into(ConstRef<VectorX<S>> parameters, Tape& tape, ConstRef<MatrixX<S>> output_gradients,
                              Eigen::Ref<MatrixX<S>> input_gradients, const E& executor = {}) const {
        require_sizes(parameters.size(), input_gradients, output_gradients, tape.max_batch);
        linear(0).input_gradient_into(linear_parameters(parameters, 0), gradients_of(0, output_gradients, tape),
                                      tape.parts.topRows(sizes_.inputs), input_gradients, executor);
    }

private:
    /// Flattened: a call would keep the loop from vectorising.
    [[gnu::flatten]] static void activate(S* values, Index count) {
        for (Index i = 0; i < count; ++i) {
            values[i] = A::at(values[i]).value;
        }
    }
    [[gnu::flatten]] static void activate(S* values, S* slopes, Index count) {
        for (Index i = 0; i < count; ++i) {
            const ActivationValue<S> activation = A::at(values[i]);
            values[i] = activation.value;
            slopes[i] = activation.slope;
        }
    }

    void name_tensors() {
        const auto add = [this](Index module, const char* name, std::vector<Index> shape) {
            tensors_.push_back({std::to_string(module) + name, std::move(shape), num_parameters_});
            num_parameters_ += tensors_.back().size();
        };
        for (Index k = 0; k <= num_hidden(); ++k) {
            offsets_.push_back(num_parameters_);
            add(3 * k, ".weight", {linear(k).outputs(), linear(k).inputs()});
            add(3 * k, ".bias", {linear(k).outputs()});
            if (k < num_hidden()) {
                offsets_.push_back(num_parameters_);
                add(3 * k + 1, ".weight", {norm(k).features()});
                add(3 * k + 1, ".bias", {norm(k).features()});
            }
        }
    }

    Eigen::Ref<const MatrixX<S>> input_of(Index layer, ConstRef<MatrixX<S>> inputs, const Tape& tape) const {
        if (layer == 0) {
            return inputs;
        }
        return tape.hidden[size_t(layer - 1)].outputs.leftCols(tape.batch);
    }

    Eigen::Ref<const MatrixX<S>> gradients_of(Index layer, ConstRef<MatrixX<S>> output_gradients,
                                              const Tape& tape) const {
        if (layer == num_hidden()) {
            return output_gradients;
        }
        return tape.hidden[size_t(layer)].gradients.leftCols(tape.batch);
    }

    void require_sizes(Index parameters, ConstRef<MatrixX<S>> inputs, ConstRef<MatrixX<S>> outputs,
                       Index max_batch) const {
        require_parameters(parameters);
        require_outputs(inputs, outputs);
        require_inputs(inputs, max_batch);
    }
    void require_parameters(Index parameters) const {
        require(parameters == num_parameters_, "network: ", parameters, " parameters, expected ", num_parameters_);
    }
    void require_inputs(ConstRef<MatrixX<S>> inputs, Index max_batch) const {
        require(inputs.rows() == sizes_.inputs, "network: ", inputs.rows(), " inputs, expected ", sizes_.inputs);
        require(inputs.cols() >= 1 && inputs.cols() <= max_batch, "network: batch of ", inputs.cols(),
                ", expected 1 to ", max_batch);
    }
    void require_outputs(ConstRef<MatrixX<S>> inputs, ConstRef<MatrixX<S>> outputs) const {
        require(inputs.rows() != sizes_.inputs || (outputs.rows() == sizes_.outputs && outputs.cols() == inputs.cols()),
                "network: outputs ", outputs.rows(), " x ", outputs.cols(), ", expected ", sizes_.outputs, " x ",
                inputs.cols());
    }

    MlpSizes sizes_;
    std::vector<Linear<S>> linear_;
    std::vector<LayerNorm<S>> norm_;
    std::vector<ParameterTensor> tensors_;
    std::vector<Index> offsets_;  ///< of linear 0, norm 0, linear 1, ...
    Index num_parameters_ = 0;
};

}  // namespace softtissue
