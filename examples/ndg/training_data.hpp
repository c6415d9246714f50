// SPDX-License-Identifier: MIT
/// @file
/// What networks learn from: the samples of a data set as inputs and targets.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/dataset_folder.hpp>
#include <softtissue/ndg/coefficient_loss.hpp>
#include <softtissue/ndg/linear_decoder.hpp>
#include <softtissue/ndg/network_training.hpp>
#include <softtissue/ndg/neural_model.hpp>

#include <functional>
#include <vector>

namespace examples {

using namespace softtissue;

struct TrainingData {
    NetworkSamples<float> training = {}, validation = {};
    ShapeSpace<double> shape_space = {};
    Index num_bodies = 0;
    Index inverted_cells = 0;    // of all training samples, det F <= 0: a valid target
    Index skipped_vertices = 0;  // of all training samples, see rest_offsets_into()
};

/// Numbers of samples, ascending.
struct TrainingSplit {
    std::vector<Index> training, validation;
};

/// What is finished now; of the training at most `max_samples` (0: all), those with the lowest numbers, that is the first bodies.
TrainingSplit training_split(const DatasetFolder& data, Index max_samples);

struct TrainingDataOptions {
    NetworkOptions network = {};
    double shape_variance = 0.9999;
    Index max_shape_coefficients = 32;
};

/// Reads the samples; `progress` gets how many are done, of how many.
TrainingData load_training_data(const DatasetFolder& data, const TrainingSplit& split,
                                const TrainingDataOptions& options, const ThreadExecutor& executor,
                                const std::function<void(int, int)>& progress);

/// Targets as coefficients of their principal components.
struct CompressedTargets {
    NetworkSamples<float> training = {}, validation = {};
    LinearDecoder<float> decoder = {};
    CoefficientLoss<float> loss = {};
    double explained = 0.0;
};

/// Takes the targets of `data` away.
CompressedTargets compress_targets(TrainingData& data, double variance, const ThreadExecutor& executor);

}  // namespace examples
