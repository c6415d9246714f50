// SPDX-License-Identifier: MIT
#include "evaluate.hpp"

#include "../support/embedded_human.hpp"
#include "../support/progress.hpp"
#include "../support/result_folder.hpp"
#include "error_picture.hpp"
#include "evaluation_report.hpp"
#include "evaluation_run.hpp"
#include "evaluation_tables.hpp"
#include "inputs.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace examples {

namespace {

struct EvaluateSettings {
    std::string data, body, out = "ndg_evaluation", json;
    std::vector<std::string> weights{"full"};
    std::vector<std::string> models;
    std::vector<std::string> methods{"gradient", "lbs", "projective", "corotated"};
    std::vector<std::string> splits{"test", "outlier"};
    int threads = 1;
    Index max_samples = 0;
};

DatasetSplit split_of(const std::string& name) {
    return *std::find_if(all_dataset_splits.begin(), all_dataset_splits.end(),
                         [&](DatasetSplit split) { return name == to_string(split); });
}

/// Every model with every kind of weights. Two models of one name are told apart by their files.
EvaluationSetup read_setup(const EvaluateSettings& settings, const DatasetFolder& data) {
    EvaluationSetup setup{
        .models = {}, .methods = settings.methods, .threads = settings.threads, .max_samples = settings.max_samples};
    for (const std::string& file : settings.models) {
        const NeuralModel<float> model = read_model(file);
        for (const std::string& weights : settings.weights) {
            const WeightFormat format = weight_format_of(weights);
            const bool needs_inputs = format == WeightFormat::int4;
            setup.models.push_back(
                {format == WeightFormat::full ? "" : ":" + weights, file, model,
                 quantized(model, format, needs_inputs ? typical_inputs(data, model) : MatrixX<float>())});
        }
    }
    for (EvaluatedModel& model : setup.models) {
        const auto has_this_name = [&](const EvaluatedModel& other) {
            return other.model.name == model.model.name && other.file != model.file;
        };
        const bool is_alone = std::none_of(setup.models.begin(), setup.models.end(), has_this_name);
        model.name =
            model.model.name + (is_alone ? "" : "@" + std::filesystem::path(model.file).stem().string()) + model.name;
    }
    return setup;
}

/// The models of table 1; without any, the classical methods.
std::vector<ErrorMap> error_maps(const EvaluationSetup& setup, const SplitResult& split) {
    std::vector<ErrorMap> maps;
    const auto add = [&](const std::string& name) {
        const MethodEvaluation<double>& evaluation = split.find(name)->evaluation;
        maps.push_back(
            {name, evaluation.summary(&PoseFigures<double>::position).mean, evaluation.mean_vertex_errors()});
    };
    for (const EvaluatedModel& model : setup.models) {
        if (model.is_whole()) {
            add(model.name);
        }
    }
    for (const std::string& name : setup.methods) {
        if (setup.models.empty()) {
            add(name);
        }
    }
    return maps;
}

ErrorSurface error_surface(const EvaluateSettings& settings, const DatasetFolder& data) {
    return settings.body.empty() ? layered_surface(data.mean_body())
                                 : whole_surface(data.mean_body(), read_human(settings.body));
}

void write_pictures(const EvaluateSettings& settings, const ErrorSurface& surface, const EvaluationSetup& setup,
                    const SplitResult& split) {
    const std::vector<ErrorMap> maps = error_maps(setup, split);
    if (maps.empty()) {
        return;
    }
    const std::filesystem::path path =
        std::filesystem::path(settings.out) / ("errors_" + std::string(to_string(split.split)) + ".png");
    const std::string title = "Error of each vertex, " + std::to_string(split.samples.size()) +
                              " samples of the split '" + to_string(split.split) + "'";
    write_error_maps(path, surface, maps, title);
    std::printf("  %s\n", path.c_str());
}

void evaluate(const EvaluateSettings& settings) {
    watch_interrupt();
    const double begin = seconds();
    const ResultFolder results_alone(settings.out);
    const DatasetFolder data(settings.data);
    const EvaluationSetup setup = read_setup(settings, data);
    std::vector<SplitResult> splits;
    for (const std::string& name : settings.splits) {
        if (is_interrupted()) {
            break;
        }
        splits.push_back(evaluate_split(data, split_of(name), setup));
        if (splits.back().samples.empty()) {
            std::fprintf(stderr, "%s: no finished sample of the split '%s'\n", settings.data.c_str(), name.c_str());
        }
    }
    print_tables(setup, splits);
    const std::filesystem::path json = settings.json.empty() ? std::filesystem::path(settings.out) / "results.json"
                                                             : std::filesystem::path(settings.json);
    write_tables(json, data, setup, splits, seconds() - begin);
    std::printf("%s\n  %s\n", is_interrupted() ? "interrupted; results up to there in" : "results in", json.c_str());
    std::erase_if(splits, [](const SplitResult& split) { return split.samples.empty(); });
    const ErrorSurface surface = error_surface(settings, data);
    std::vector<std::vector<ErrorMap>> maps;
    for (const SplitResult& split : splits) {
        write_pictures(settings, surface, setup, split);
        maps.push_back(error_maps(setup, split));
    }
    const std::filesystem::path page = std::filesystem::path(settings.out) / "report.html";
    if (write_evaluation_report(page, setup, splits, surface, maps)) {
        std::printf("  %s\n", page.c_str());
    }
}

}  // namespace

void add_evaluate(CLI::App& app) {
    const auto settings = std::make_shared<EvaluateSettings>();
    CLI::App* const command = app.add_subcommand(
        "evaluate",
        "Trained models beside classical methods on samples that no training has seen: tables, errors on the body.");
    command->add_option("--data", settings->data, "folder of the data set")->required();
    command->add_option("--models", settings->models, "trained models (.safetensors)");
    command
        ->add_option("--weights", settings->weights,
                     "of the models: full, bfloat16, int8, int4; each of those named is evaluated")
        ->delimiter(',')
        ->check(CLI::IsMember(weight_format_names()))
        ->capture_default_str();
    command
        ->add_option("--methods", settings->methods,
                     "classical ones: of lbs, dqs, gradient, projective, corotated; none")
        ->delimiter(',')
        ->check(CLI::IsMember({"lbs", "dqs", "gradient", "projective", "corotated", "none"}))
        ->capture_default_str();
    command->add_option("--split", settings->splits, "of test, outlier, validation, train")
        ->delimiter(',')
        ->check(CLI::IsMember({"test", "outlier", "validation", "train"}))
        ->capture_default_str();
    command->add_option("--max-samples", settings->max_samples, "at most so many of each split; 0: all")
        ->capture_default_str();
    command->add_option("--threads", settings->threads, "bodies at a time; the figures do not depend on it")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--body", settings->body,
                        "the data set's body in SMPL's layout (.npz): pictures then show all of it");
    command->add_option("--out", settings->out, "folder for results")->capture_default_str();
    command->add_option("--json", settings->json, "file for the tables (default: OUT/results.json)");
    command->callback([settings] {
        std::erase(settings->methods, "none");
        evaluate(*settings);
    });
}

}  // namespace examples
