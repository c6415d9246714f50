// SPDX-License-Identifier: MIT
#include "training_results.hpp"

#include "../support/line_chart.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace examples {

LineChart loss_chart(const std::string& model, const std::vector<TrainingStage>& stages) {
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
    return chart;
}

void write_loss_chart(const std::string& file, const LineChart& chart) {
    write_line_chart(file, chart);
}

bool write_training_report(const std::string& file, const std::string& model, const std::vector<TrainingStage>& stages,
                           const std::vector<ReportFigure>& figures) {
    HtmlReport page(
        {.program = "ndg train",
         .title = "Training of " + model,
         .summary =
             "Losses on the samples of the training and on those of the validation, which it does not learn from"});
    for (const ReportFigure& figure : figures) {
        page.add_figure(figure);
    }
    page.add_chart(loss_chart(model, stages));
    ReportTable table{.title = "Stages",
                      .columns = {{"Stage"},
                                  {"End"},
                                  {"Epochs", "", 0},
                                  {"Best epoch", "", 0},
                                  {"Best validation loss"},
                                  {"Training loss there"},
                                  {"Time", "s", 1}}};
    for (const TrainingStage& stage : stages) {
        const size_t best = size_t(std::max<Index>(stage.best_epoch, 1) - 1);
        table.rows.push_back(
            {.cells = {stage.name, stage.status, double(stage.training.size()), double(stage.best_epoch), stage.best,
                       best < stage.training.size() ? stage.training[best] : std::nan(""), stage.seconds}});
    }
    page.add_table(std::move(table));
    return page.write(file);
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
