// SPDX-License-Identifier: MIT
/// @file
/// Motions and models that the subcommands start from.
#pragma once

#include "../support/layered_human.hpp"

#include <softtissue/ndg/dataset_plan.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/nn/quantized_mlp.hpp>
#include <softtissue/nn/weight_format.hpp>

#include <memory>
#include <string>
#include <vector>

namespace examples {

/// The motions in files of AMASS's layout, the second ones held out; the embedded one if there are none.
std::vector<softtissue::DatasetClip> read_clips(const std::vector<std::string>& paths,
                                                const std::vector<std::string>& held_out, softtissue::Index num_joints);

softtissue::NeuralModel<float> read_model(const std::string& path);

/// The format of that name; what the option --weights takes.
softtissue::WeightFormat weight_format_of(const std::string& name);
std::vector<std::string> weight_format_names();

/// The model's network in that format; none for the full one. Typical inputs: one a column.
std::unique_ptr<const softtissue::QuantizedMlp<float>> quantized(const softtissue::NeuralModel<float>& model,
                                                                 softtissue::WeightFormat format,
                                                                 const softtissue::MatrixX<float>& typical_inputs);

}  // namespace examples
