// SPDX-License-Identifier: MIT
#include "training_results.hpp"

#include "../support/line_chart.hpp"

#include <utility>

namespace examples {

void write_loss_chart(const std::string& file, const std::string& model, const std::vector<TrainingStage>& stages) {
    LineChart chart{
        .title = model + ": loss", .x_title = "epoch", .y_title = "mean loss of a sample", .is_log_y = true};
    double epoch = 0;
    for (const TrainingStage& stage : stages) {
        LineSeries training{.name = stage.name}, validation{.name = stage.name + ", validation", .is_dashed = true};
        for (size_t k = 0; k < stage.training.size(); ++k) {
            training.x.push_back(epoch + double(k + 1));
            validation.x.push_back(epoch + double(k + 1));
        }
        training.y = stage.training;
        validation.y = stage.validation;
        chart.series.push_back(std::move(training));
        chart.series.push_back(std::move(validation));
        if (stage.best_epoch > 0) {
            chart.marks.push_back({epoch + double(stage.best_epoch), "kept"});
        }
        epoch += double(stage.training.size());
    }
    write_line_chart(file, chart);
}

nlohmann::ordered_json stages_json(const std::vector<TrainingStage>& stages) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const TrainingStage& stage : stages) {
        json.push_back({{"name", stage.name},
                        {"status", stage.status},
                        {"seconds", stage.seconds},
                        {"best_validation_loss", stage.best},
                        {"best_epoch", stage.best_epoch},
                        {"training_losses", stage.training},
                        {"validation_losses", stage.validation}});
    }
    return json;
}

}  // namespace examples
