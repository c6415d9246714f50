// SPDX-License-Identifier: MIT
#include "train.hpp"

#include "../support/line_chart.hpp"
#include "../support/progress.hpp"
#include "training_data.hpp"
#include "training_run.hpp"

#include <softtissue/io/fingerprint.hpp>
#include <softtissue/io/neural_model_file.hpp>
#include <softtissue/ndg/body_identity.hpp>
#include <softtissue/ndg/linear_decoder.hpp>
#include <softtissue/ndg/residual_logarithms.hpp>

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace examples {

namespace {

/// What can be trained.
struct Variant {
    NetworkOptions network = {};
    bool compressed = false;  // in the coefficients of fixed principal components: of logarithms, or of offsets
    Index epochs = 30;
    Index patience = 0;
};

const std::map<std::string, Variant> variants{
    {"ndg", {}},
    {"ndg-pca", {.compressed = true, .epochs = 60}},
    {"vertexnet", {.network = {.kind = NetworkKind::vertex}, .compressed = true, .epochs = 150, .patience = 40}},
    {"no-exponential", {.network = {.exponential = false}}},
    {"no-rotation", {.network = {.rotation = false}}},
    {"no-shape", {.network = {.shape_input = false}}}};

struct Settings {
    std::string data = "ndg_data", model = "ndg", out, json, png;
    std::vector<Index> hidden{384, 384, 96};
    Index epochs = 0, fine_tune = 0, batch = 16, patience = -1, samples = 0, warm_up = 20;
    double learning_rate = 1.3e-3, fine_tune_rate = 3e-4, weight_decay = 0.01, final_fraction = 0.02;
    double variance = 0.995, checkpoint_seconds = 60;
    std::uint64_t seed = 1;
    int threads = 1;
};

/// One part of a training: its losses, a number an epoch.
struct Stage {
    std::string name;
    std::vector<double> training, validation;
    double best = 0.0;
    Index best_epoch = 0;
    double seconds = 0.0;
    std::string status;
};

class Trainer {
public:
    explicit Trainer(const Settings& settings)
        : settings_(settings),
          variant_(variants.at(settings.model)),
          data_(settings.data),
          split_(training_split(data_, settings.samples)),
          executor_(settings.threads) {}

    void run() {
        load();
        Mlp<float> mlp =
            variant_.compressed ? train_compressed() : train_whole(new_network(), "training", 0, settings_.epochs);
        if (variant_.compressed && settings_.fine_tune > 0 && !interrupted_) {
            load();
            mlp = train_whole(mlp, "fine tuning", settings_.fine_tune_rate, settings_.fine_tune);
        }
        if (interrupted_) {
            std::printf("stopped: the same command goes on\n");
            return;
        }
        write_results(mlp);
    }

private:
    void load() {
        const double begin = seconds();
        std::unique_ptr<Progress> line;
        loaded_ = load_training_data(data_, split_, {.network = variant_.network}, executor_, [&](int done, int total) {
            if (line == nullptr) {
                line = std::make_unique<Progress>("samples", total);
            }
            line->update(done);
        });
        num_training_ = loaded_.training.count();
        num_validation_ = loaded_.validation.count();
        std::printf(
            "%td training samples of %td bodies, %td validation samples; %td inputs (%td of the shape), %td outputs; "
            "%.0f s\n",
            num_training_, loaded_.num_bodies, num_validation_, loaded_.training.inputs.rows(),
            loaded_.shape_space.num_coefficients(), loaded_.training.targets.rows(), seconds() - begin);
        if (variant_.network.kind == NetworkKind::gradient) {
            std::printf("%td of the training's cells are inverted\n", loaded_.inverted_cells);
        } else if (loaded_.skipped_vertices > 0) {
            std::printf("%td of the training's vertices have no inverse skinning and count as not moved\n",
                        loaded_.skipped_vertices);
        }
        std::fflush(stdout);
    }

    Mlp<float> new_network(Index outputs = 0) const {
        Mlp<float> mlp({.inputs = loaded_.training.inputs.rows(),
                        .hidden = settings_.hidden,
                        .outputs = outputs > 0 ? outputs : loaded_.training.targets.rows()});
        mlp.initialize(settings_.seed, 0.1F);
        return mlp;
    }

    Mlp<float> train_compressed() {
        const double begin = seconds();
        NetworkSamples<float> validation;
        if (variant_.network.kind == NetworkKind::gradient) {
            validation = loaded_.validation;
            const LogarithmCounts counts = residual_logarithms_in_place<float>(loaded_.training.targets, executor_);
            residual_logarithms_in_place<float>(loaded_.validation.targets, executor_);
            std::printf("logarithms: %td cells repaired, %td dropped\n", counts.repaired, counts.dropped);
        }
        const CompressedTargets targets = compress_targets(loaded_, settings_.variance, executor_);
        std::printf("%td principal components explain %.2f %% of the variance; %.0f s\n", targets.decoder.weight.cols(),
                    100 * targets.explained, seconds() - begin);
        std::fflush(stdout);
        notes_["components"] = std::to_string(targets.decoder.weight.cols());
        Mlp<float> mlp = new_network(targets.decoder.weight.cols());
        mlp.parameters() = train_stage("training", settings_.learning_rate, settings_.epochs, mlp, targets.loss,
                                       targets.training, targets.validation);
        mlp = fold_decoder(mlp, targets.decoder);
        if (validation.count() > 0) {
            const double loss = mean_gradient_loss(mlp, validation, settings_.batch, executor_);
            std::printf("validation loss of the gradients: %.4g\n", loss);
            notes_["gradient_loss"] = std::to_string(loss);
        }
        return mlp;
    }

    Mlp<float> train_whole(Mlp<float> mlp, const std::string& name, double learning_rate, Index epochs) {
        const double rate = learning_rate > 0 ? learning_rate : settings_.learning_rate;
        if (variant_.network.kind == NetworkKind::gradient) {
            mlp.parameters() = train_stage(name, rate, epochs, mlp, GradientLoss<float>{variant_.network.exponential},
                                           loaded_.training, loaded_.validation);
        } else {
            const Index outputs = mlp.sizes().outputs;
            const CoefficientLoss<float> loss{VectorX<float>::Constant(outputs, 1.0F / float(outputs))};
            mlp.parameters() = train_stage(name, rate, epochs, mlp, loss, loaded_.training, loaded_.validation);
        }
        return mlp;
    }

    /// The best parameters.
    template <class Loss>
    VectorX<float> train_stage(const std::string& name, double learning_rate, Index epochs, const Mlp<float>& start,
                               const Loss& loss, const NetworkSamples<float>& training,
                               const NetworkSamples<float>& validation) {
        const double begin = seconds();
        TrainingRun run;
        run.name = settings_.model + ", " + name;
        run.options = {
            .epochs = epochs, .batch = settings_.batch, .patience = settings_.patience, .seed = settings_.seed};
        run.options.optimizer.learning_rate = learning_rate;
        run.options.optimizer.weight_decay = settings_.weight_decay;
        run.options.schedule = {settings_.warm_up, settings_.final_fraction};
        run.checkpoint = {checkpoint_path(stages_.size()), description(run.options, start, training),
                          settings_.checkpoint_seconds};
        TrainingState<float> state(start.parameters());
        const TrainingReport report = run_training(run, start.layers(), loss, training, validation, state, executor_);
        const Index steps_per_epoch = (training.count() + settings_.batch - 1) / settings_.batch;
        stages_.push_back({name, state.training_losses, state.validation_losses, state.best_loss,
                           state.best_step / steps_per_epoch, seconds() - begin, to_string(report.status)});
        interrupted_ = report.status == TrainingStatus::cancelled;
        require(report.status != TrainingStatus::not_finite, settings_.model, ": the loss is not finite after step ",
                report.step, "; a smaller --learning-rate may help");
        return state.best_parameters;
    }

    std::filesystem::path checkpoint_path(size_t stage) const {
        return settings_.out + (stage == 0 ? ".checkpoint" : ".checkpoint" + std::to_string(stage + 1));
    }

    /// All that decides about the bits of a training.
    std::string description(const TrainingOptions& options, const Mlp<float>& start,
                            const NetworkSamples<float>& training) const {
        std::ostringstream text;
        text.precision(17);
        text << settings_.model << ", batch " << options.batch << ", epochs " << options.epochs << ", patience "
             << options.patience << ", seed " << options.seed << ", rate " << options.optimizer.learning_rate
             << ", decay " << options.optimizer.weight_decay << ", warm-up " << options.schedule.warm_up_steps
             << ", final fraction " << options.schedule.final_fraction << ", samples " << training.count()
             << ", content "
             << Fingerprint()
                    .add(training.inputs)
                    .add(VectorX<float>(training.targets.col(0)))
                    .add(start.parameters())
                    .text();
        return text.str();
    }

    void write_results(const Mlp<float>& mlp) {
        const Stage& last = stages_.back();
        const auto text = [](double value) {
            char buffer[32];
            std::snprintf(buffer, sizeof buffer, "%.6g", value);
            return std::string(buffer);
        };
        notes_["samples"] = std::to_string(num_training_);
        notes_["bodies"] = std::to_string(loaded_.num_bodies);
        notes_["epochs"] = std::to_string(last.training.size());
        notes_["best_epoch"] = std::to_string(last.best_epoch);
        notes_["batch"] = std::to_string(settings_.batch);
        notes_["seed"] = std::to_string(settings_.seed);
        notes_["validation_loss"] = text(last.best);
        notes_["training_loss"] =
            text(last.training.empty() ? 0.0 : last.training[size_t(std::max<Index>(last.best_epoch, 1) - 1)]);
        if (stages_.size() > 1) {
            notes_["fine_tuned"] = "true";
        }
        const NeuralModel<float> model{settings_.model + (stages_.size() > 1 ? "-fine" : ""),
                                       variant_.network,
                                       mlp,
                                       loaded_.shape_space,
                                       body_identity(data_.mean_body(), data_.tree(), data_.joint_names()),
                                       notes_};
        write_neural_model(settings_.out, model);
        write_chart();
        write_json(model);
        for (size_t stage = 0; stage < stages_.size(); ++stage) {
            std::filesystem::remove(checkpoint_path(stage));
        }
        for (const Stage& stage : stages_) {
            std::printf("%s: %s; best validation loss %.4g after epoch %td of %zu; %.0f s\n", stage.name.c_str(),
                        stage.status.c_str(), stage.best, stage.best_epoch, stage.training.size(), stage.seconds);
        }
        std::printf("%td parameters in %s\n  %s\n  %s\n", mlp.parameters().size(), settings_.out.c_str(),
                    settings_.png.c_str(), settings_.json.c_str());
    }

    void write_chart() const {
        LineChart chart{.title = settings_.model + ": loss",
                        .x_title = "epoch",
                        .y_title = "mean loss of a sample",
                        .is_log_y = true};
        double epoch = 0;
        for (const Stage& stage : stages_) {
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
        write_line_chart(settings_.png, chart);
    }

    void write_json(const NeuralModel<float>& model) const {
        nlohmann::ordered_json json{{"model", model.name},
                                    {"file", settings_.out},
                                    {"data", settings_.data},
                                    {"training_samples", num_training_},
                                    {"training_bodies", loaded_.num_bodies},
                                    {"validation_samples", num_validation_},
                                    {"inverted_cells", loaded_.inverted_cells},
                                    {"skipped_vertices", loaded_.skipped_vertices},
                                    {"shape_coefficients", loaded_.shape_space.num_coefficients()},
                                    {"parameters", model.mlp.parameters().size()},
                                    {"hidden", settings_.hidden},
                                    {"batch", settings_.batch},
                                    {"learning_rate", settings_.learning_rate},
                                    {"weight_decay", settings_.weight_decay},
                                    {"seed", settings_.seed},
                                    {"threads", settings_.threads}};
        for (const Stage& stage : stages_) {
            json["stages"].push_back({{"name", stage.name},
                                      {"status", stage.status},
                                      {"seconds", stage.seconds},
                                      {"best_validation_loss", stage.best},
                                      {"best_epoch", stage.best_epoch},
                                      {"training_losses", stage.training},
                                      {"validation_losses", stage.validation}});
        }
        AtomicFile file(settings_.json);
        file.write(json.dump(2) + "\n");
        file.commit();
    }

    Settings settings_;
    Variant variant_;
    DatasetFolder data_;
    TrainingSplit split_;
    ThreadExecutor executor_;
    TrainingData loaded_;
    Index num_training_ = 0, num_validation_ = 0;
    std::vector<Stage> stages_;
    std::map<std::string, std::string> notes_;
    bool interrupted_ = false;
};

void complete(Settings& settings) {
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
    const auto settings = std::make_shared<Settings>();
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
        Trainer(*settings).run();
    });
}

}  // namespace examples
