// SPDX-License-Identifier: MIT
/// @file
/// The losses of a training as a picture and as numbers.
#pragma once

#include <softtissue/core/notation.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace examples {

using namespace softtissue;

/// One part of a training: its losses, a number an epoch.
struct TrainingStage {
    std::string name;
    std::vector<double> training, validation;
    double best = 0.0;
    Index best_epoch = 0;
    double seconds = 0.0;
    std::string status;
};

/// All stages one after the other (PNG).
void write_loss_chart(const std::string& file, const std::string& model, const std::vector<TrainingStage>& stages);

nlohmann::ordered_json stages_json(const std::vector<TrainingStage>& stages);

}  // namespace examples
