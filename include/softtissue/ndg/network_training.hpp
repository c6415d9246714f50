// SPDX-License-Identifier: MIT
/// @file
/// A network, its samples and a loss: what train() needs.
///
/// What        NetworkTraining, a TrainableModel (nn/train.hpp); OutputLoss, the concept of its loss.
/// OutputLoss  `using Scalar`, and two const functions, whose results must not depend on the executor:
///               loss(outputs, targets, columns, executor)                mean loss of a batch; column k of the outputs
///                                                                        belongs to column columns[k] of the targets
///               loss_and_gradient(outputs, targets, columns, executor)   the same; replaces the outputs by its derivative
/// Shapes      inputs features x samples, targets outputs x samples: one column a sample
/// Refuses     inputs of another network, inputs or targets that are not finite (InvalidInput names the sample)
/// Cost        a batch is one matrix through every layer. Nothing is allocated once a full batch has been seen.
/// Tests       tests/unit/ndg/network_training_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/mlp_layers.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

template <class L>
concept OutputLoss = requires(const L& loss, MatrixX<typename L::Scalar>& outputs,
                              const MatrixX<typename L::Scalar>& targets, std::span<const std::int32_t> columns,
                              const SequentialExecutor& executor) {
    { loss.loss(outputs, targets, columns, executor) } -> std::same_as<double>;
    { loss.loss_and_gradient(outputs, targets, columns, executor) } -> std::same_as<double>;
};

/// One column a sample.
template <RealScalar S>
struct NetworkSamples {
    MatrixX<S> inputs = {};
    MatrixX<S> targets = {};

    Index count() const { return inputs.cols(); }
};

template <OutputLoss Loss, Executor E = SequentialExecutor>
class NetworkTraining {
public:
    using Scalar = typename Loss::Scalar;

    using Layers = MlpLayers<Scalar>;

    /// Samples and executor must outlive this.
    NetworkTraining(Layers layers, Loss loss, const NetworkSamples<Scalar>& training,
                    const NetworkSamples<Scalar>& validation, Index max_batch, const E& executor)
        : layers_(std::move(layers)),
          loss_(std::move(loss)),
          training_(&training),
          validation_(&validation),
          executor_(&executor),
          max_batch_(max_batch),
          tape_(layers_.make_tape(max_batch)),
          inputs_(layers_.sizes().inputs, max_batch),
          outputs_(layers_.sizes().outputs, max_batch) {
        require(max_batch > 0, "network training: batches of ", max_batch, " samples, expected at least 1");
        require_samples(training, "training");
        require_samples(validation, "validation");
    }

    Index num_parameters() const { return layers_.num_parameters(); }
    Index num_samples() const { return training_->count(); }

    /// Mean loss of the given training samples and its derivative by the parameters.
    Scalar loss_and_gradient(const VectorX<Scalar>& parameters, std::span<const std::int32_t> samples,
                             VectorX<Scalar>& gradient) {
        const Index count = gather(*training_, samples);
        gradient.resize(num_parameters());
        layers_.forward_into(parameters, inputs_.leftCols(count), tape_, outputs_.leftCols(count), *executor_);
        const double loss = loss_.loss_and_gradient(outputs_.leftCols(count), training_->targets, samples, *executor_);
        layers_.backward_into(parameters, inputs_.leftCols(count), tape_, outputs_.leftCols(count), gradient,
                              *executor_);
        return Scalar(loss);
    }

    /// Mean loss of all validation samples.
    Scalar validation_loss(const VectorX<Scalar>& parameters) { return mean_loss(parameters, *validation_); }

    /// Mean loss of other samples.
    Scalar mean_loss(const VectorX<Scalar>& parameters, const NetworkSamples<Scalar>& samples) {
        std::vector<std::int32_t> all(size_t(samples.count()));
        std::iota(all.begin(), all.end(), 0);
        double sum = 0;
        for (size_t first = 0; first < all.size(); first += size_t(max_batch_)) {
            const std::span<const std::int32_t> batch =
                std::span<const std::int32_t>(all).subspan(first, std::min(size_t(max_batch_), all.size() - first));
            const Index count = gather(samples, batch);
            layers_.forward_into(parameters, inputs_.leftCols(count), tape_, outputs_.leftCols(count), *executor_);
            sum += double(count) * loss_.loss(outputs_.leftCols(count), samples.targets, batch, *executor_);
        }
        return Scalar(sum / double(samples.count()));
    }

private:
    void require_samples(const NetworkSamples<Scalar>& samples, const char* which) const {
        require(samples.count() > 0, "network training: no ", which, " samples");
        require(samples.inputs.rows() == layers_.sizes().inputs && samples.targets.cols() == samples.count(),
                "network training: ", which, " inputs of ", samples.inputs.rows(), " numbers, expected ",
                layers_.sizes().inputs, ", for ", samples.targets.cols(), " targets, expected ", samples.count());
        for (Index k = 0; k < samples.count(); ++k) {
            require(samples.inputs.col(k).allFinite() && samples.targets.col(k).allFinite(),
                    "network training: ", which, " sample ", k, " is not finite");
        }
    }

    Index gather(const NetworkSamples<Scalar>& samples, std::span<const std::int32_t> columns) {
        require(Index(columns.size()) <= max_batch_, "network training: a batch of ", columns.size(),
                " samples, expected at most ", max_batch_);
        for (size_t k = 0; k < columns.size(); ++k) {
            inputs_.col(Index(k)) = samples.inputs.col(columns[k]);
        }
        return Index(columns.size());
    }

    Layers layers_;
    Loss loss_;
    const NetworkSamples<Scalar>* training_;
    const NetworkSamples<Scalar>* validation_;
    const E* executor_;
    Index max_batch_;
    typename Layers::Tape tape_;
    MatrixX<Scalar> inputs_, outputs_;
};

}  // namespace softtissue
