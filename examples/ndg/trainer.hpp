// SPDX-License-Identifier: MIT
/// @file
/// Trains one model from a data set, and goes on with a training that was stopped.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/ndg/neural_model.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace examples {

using namespace softtissue;

/// What can be trained.
struct Variant {
    NetworkOptions network = {};
    bool compressed = false;  // in the coefficients of fixed principal components: of logarithms, or of offsets
    Index epochs = 30;
    Index patience = 0;
};

inline const std::map<std::string, Variant> variants{
    {"ndg", {}},
    {"ndg-pca", {.compressed = true, .epochs = 60}},
    {"vertexnet", {.network = {.kind = NetworkKind::vertex}, .compressed = true, .epochs = 150, .patience = 40}},
    {"no-exponential", {.network = {.exponential = false}}},
    {"no-rotation", {.network = {.rotation = false}}},
    {"no-shape", {.network = {.shape_input = false}}}};

/// `model` names a variant; numbers below 0, and 0 epochs, stand for the variant's own.
struct TrainSettings {
    std::string data = "ndg_data", model = "ndg", out, json, png;
    std::vector<Index> hidden{384, 384, 96};
    Index epochs = 0, fine_tune = 0, batch = 16, patience = -1, samples = 0, warm_up = 20;
    double learning_rate = 1.3e-3, fine_tune_rate = 3e-4, weight_decay = 0.01, final_fraction = 0.02;
    double variance = 0.995, checkpoint_seconds = 60;
    std::uint64_t seed = 1;
    int threads = 1;
};

/// Writes the model and, beside it, its losses as a picture and as numbers; after Ctrl-C only a checkpoint.
void train_model(const TrainSettings& settings);

}  // namespace examples
