// SPDX-License-Identifier: MIT
#include "inputs.hpp"

#include "../support/amass_motion.hpp"
#include "../support/embedded_human.hpp"

#include <softtissue/io/neural_model_file.hpp>

#include <algorithm>
#include <filesystem>

namespace examples {

using namespace softtissue;

std::vector<DatasetClip> read_clips(const std::vector<std::string>& paths, const std::vector<std::string>& held_out,
                                    Index num_joints) {
    std::vector<DatasetClip> clips;
    for (const auto* list : {&paths, &held_out}) {
        for (const std::string& path : *list) {
            clips.push_back(
                {std::filesystem::path(path).stem().string(), read_motion(path, num_joints), list == &held_out});
        }
    }
    if (clips.empty()) {
        clips.push_back({"procedural", embedded_motion()});
    }
    return clips;
}

NeuralModel<float> read_model(const std::string& path) {
    return read_neural_model<float>(path);
}

WeightFormat weight_format_of(const std::string& name) {
    return *std::find_if(all_weight_formats.begin(), all_weight_formats.end(),
                         [&](WeightFormat format) { return name == to_string(format); });
}

std::vector<std::string> weight_format_names() {
    std::vector<std::string> names;
    for (const WeightFormat format : all_weight_formats) {
        names.emplace_back(to_string(format));
    }
    return names;
}

std::unique_ptr<const QuantizedMlp<float>> quantized(const NeuralModel<float>& model, WeightFormat format,
                                                     const MatrixX<float>& typical_inputs) {
    if (format == WeightFormat::full) {
        return nullptr;
    }
    return std::make_unique<const QuantizedMlp<float>>(model.mlp, format, typical_inputs);
}

}  // namespace examples
