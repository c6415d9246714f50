// SPDX-License-Identifier: MIT
#include "train.hpp"

#include "../support/progress.hpp"
#include "trainer.hpp"

#include <softtissue/core/error.hpp>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace examples {

namespace {

void complete(TrainSettings& settings) {
    const Variant& variant = variants.at(settings.model);
    settings.out = settings.out.empty() ? settings.model + ".safetensors" : settings.out;
    const std::string stem = std::filesystem::path(settings.out).replace_extension().string();
    settings.json = settings.json.empty() ? stem + ".json" : settings.json;
    settings.png = settings.png.empty() ? stem + ".png" : settings.png;
    settings.epochs = settings.epochs > 0 ? settings.epochs : variant.epochs;
    settings.patience = settings.patience >= 0 ? settings.patience : variant.patience;
    require(settings.fine_tune == 0 || variant.compressed, "--fine-tune: ", settings.model,
            " is trained as a whole already, expected ndg-pca or vertexnet");
}

}  // namespace

void add_train(CLI::App& app) {
    const auto settings = std::make_shared<TrainSettings>();
    CLI::App* const command = app.add_subcommand(
        "train", "A network from a data set. Stopped in any way, the same command goes on from its last checkpoint.");
    std::vector<std::string> names;
    for (const auto& [name, variant] : variants) {
        names.push_back(name);
    }
    command->add_option("--data", settings->data, "folder of the data set")->capture_default_str();
    command
        ->add_option("--model", settings->model,
                     "ndg; ndg-pca: the same, learnt as coefficients of fixed principal components of the logarithms; "
                     "vertexnet; or ndg without one of its parts")
        ->check(CLI::IsMember(names))
        ->capture_default_str();
    command->add_option("--out", settings->out, "file of the model (default: MODEL.safetensors)");
    command->add_option("--epochs", settings->epochs, "epochs; 0: 30, of ndg-pca 60, of vertexnet 150")
        ->capture_default_str();
    command
        ->add_option("--fine-tune", settings->fine_tune,
                     "for ndg-pca and vertexnet: epochs in which the whole network is trained further")
        ->capture_default_str();
    command->add_option("--hidden", settings->hidden, "sizes of the hidden layers")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--batch", settings->batch, "samples a step")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--learning-rate", settings->learning_rate, "largest learning rate")->capture_default_str();
    command->add_option("--fine-tune-rate", settings->fine_tune_rate, "the same for --fine-tune")
        ->capture_default_str();
    command->add_option("--weight-decay", settings->weight_decay, "AdamW's")->capture_default_str();
    command->add_option("--variance", settings->variance, "variance that the principal components explain")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command->add_option(
        "--patience", settings->patience,
        "epochs without a better validation loss after which to stop; 0: never; default: vertexnet 40, others 0");
    command->add_option("--samples", settings->samples, "training samples, the first ones; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_option("--seed", settings->seed, "seed of weights and order")->capture_default_str();
    command->add_option("--threads", settings->threads, "threads; the result does not depend on them")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        ->add_option("--checkpoint-seconds", settings->checkpoint_seconds,
                     "seconds between checkpoints (OUT.checkpoint)")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_option("--png", settings->png, "picture of the losses (default: beside OUT)");
    command->add_option("--json", settings->json, "losses and sizes (default: beside OUT)");
    command->callback([settings] {
        complete(*settings);
        watch_interrupt();
        train_model(*settings);
    });
}

}  // namespace examples
