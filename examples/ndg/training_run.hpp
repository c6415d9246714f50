// SPDX-License-Identifier: MIT
/// @file
/// One training with its progress on the terminal and a checkpoint in a file.
#pragma once

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/resumable_training.hpp>
#include <softtissue/ndg/coefficient_loss.hpp>
#include <softtissue/ndg/gradient_loss.hpp>
#include <softtissue/ndg/network_training.hpp>
#include <softtissue/nn/mlp.hpp>

#include <string>

namespace examples {

using namespace softtissue;

struct TrainingRun {
    std::string name;  // on the terminal
    TrainingOptions options;
    CheckpointOptions checkpoint;
};

/// Trains `state` to its end, or until Ctrl-C.
TrainingReport run_training(const TrainingRun& run, const MlpLayers<float>& layers, const GradientLoss<float>& loss,
                            const NetworkSamples<float>& training, const NetworkSamples<float>& validation,
                            TrainingState<float>& state, const ThreadExecutor& executor);
TrainingReport run_training(const TrainingRun& run, const MlpLayers<float>& layers, const CoefficientLoss<float>& loss,
                            const NetworkSamples<float>& training, const NetworkSamples<float>& validation,
                            TrainingState<float>& state, const ThreadExecutor& executor);

/// Of gradients, whatever the network was trained with.
double mean_gradient_loss(const Mlp<float>& mlp, const NetworkSamples<float>& samples, Index batch,
                          const ThreadExecutor& executor);

}  // namespace examples
