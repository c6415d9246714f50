// SPDX-License-Identifier: MIT
/// @file
/// The losses of a training as a picture and as numbers.
#pragma once

#include "../support/chart.hpp"
#include "../support/html_report.hpp"

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

/// All stages one after the other.
LineChart loss_chart(const std::string& model, const std::vector<TrainingStage>& stages);

/// As a PNG.
void write_loss_chart(const std::string& file, const LineChart& chart);

/// As a page, if it was built.
bool write_training_report(const std::string& file, const std::string& model, const std::vector<TrainingStage>& stages,
                           const std::vector<ReportFigure>& figures);

nlohmann::ordered_json stages_json(const std::vector<TrainingStage>& stages);

}  // namespace examples
