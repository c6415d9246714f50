// SPDX-License-Identifier: MIT
/// @file
/// All methods on all samples of a split.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/io/dataset_folder.hpp>
#include <softtissue/ndg/evaluation.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace examples {

using namespace softtissue;

/// A trained model and what the tables call it.
struct EvaluatedModel {
    std::string name;
    std::string file;
    NeuralModel<float> model;
    std::shared_ptr<const QuantizedMlp<float>> small = {};  // its network in fewer bytes, if so asked

    /// Nothing of the source's method was taken away.
    bool is_whole() const { return model.options.exponential && model.options.rotation && model.options.shape_input; }
};

/// One method on all samples of a split. Vertex errors are those of the columns: muscle wrap and skin, averaged.
struct MethodResult {
    std::string name;
    MethodEvaluation<double> evaluation = {};
    int not_converged = 0;
    std::optional<double> smallest_determinant = {};  // over all gradients that a network predicted
};

struct SplitResult {
    DatasetSplit split = DatasetSplit::test;
    std::vector<Index> samples;         // those that were measured, ascending
    std::vector<MethodResult> methods;  // "fem" first, then the models, then the classical ones
    Index num_bodies = 0;
    bool is_interrupted = false;

    const MethodResult* find(const std::string& name) const {
        for (const MethodResult& method : methods) {
            if (method.name == name) {
                return &method;
            }
        }
        return nullptr;
    }
};

struct EvaluationSetup {
    std::vector<EvaluatedModel> models;
    std::vector<std::string> methods;  // classical ones, by the names of LayeredAnimation
    int threads = 1;
    Index max_samples = 0;  // 0: all
};

/// Inputs of a model for at most 200 samples of the training.
MatrixX<float> typical_inputs(const DatasetFolder& data, const NeuralModel<float>& model);

/// The same figures for any number of threads, times excepted. Ctrl-C ends it early; what was measured until then counts.
SplitResult evaluate_split(const DatasetFolder& data, DatasetSplit split, const EvaluationSetup& setup);

}  // namespace examples
