// SPDX-License-Identifier: MIT
#include "trainer.hpp"

#include "../support/progress.hpp"
#include "../support/result_file.hpp"
#include "training_data.hpp"
#include "training_results.hpp"
#include "training_run.hpp"

#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/fingerprint.hpp>
#include <softtissue/io/neural_model_file.hpp>
#include <softtissue/ndg/body_identity.hpp>
#include <softtissue/ndg/linear_decoder.hpp>
#include <softtissue/ndg/residual_logarithms.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace examples {

namespace {

class Trainer {
public:
    explicit Trainer(const TrainSettings& settings)
        : settings_(settings),
          variant_(variants.at(settings.model)),
          data_(settings.data),
          split_(training_split(data_, settings.samples)),
          executor_(settings.threads) {}

    void run() {
        for (const std::string& file : {settings_.out, settings_.json, settings_.png}) {
            require_writable(file);
        }
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
        const TrainingStage& last = stages_.back();
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
        write_loss_chart(settings_.png, loss_chart(settings_.model, stages_));
        write_json(model);
        for (const TrainingStage& stage : stages_) {
            std::printf("%s: %s; best validation loss %.4g after epoch %td of %zu; %.0f s\n", stage.name.c_str(),
                        stage.status.c_str(), stage.best, stage.best_epoch, stage.training.size(), stage.seconds);
        }
        std::printf("%td parameters in %s\n  %s\n  %s\n", mlp.parameters().size(), settings_.out.c_str(),
                    settings_.png.c_str(), settings_.json.c_str());
        write_page(model);
        for (size_t stage = 0; stage < stages_.size(); ++stage) {
            std::filesystem::remove(checkpoint_path(stage));
        }
    }

    void write_page(const NeuralModel<float>& model) const {
        const std::string page = std::filesystem::path(settings_.out).replace_extension(".html").string();
        const TrainingStage& last = stages_.back();
        std::string layers;
        for (const Index size : settings_.hidden) {
            layers += (layers.empty() ? "hidden " : ", ") + std::to_string(size);
        }
        if (write_training_report(
                page, model.name, stages_,
                {{"Best validation loss", formatted("%.4g", last.best), "", "epoch " + std::to_string(last.best_epoch)},
                 {"Training samples", std::to_string(num_training_), "",
                  std::to_string(loaded_.num_bodies) + " bodies"},
                 {"Validation samples", std::to_string(num_validation_)},
                 {"Parameters", std::to_string(model.mlp.parameters().size()), "", layers},
                 {"Batch", std::to_string(settings_.batch), "samples"},
                 {"Learning rate", formatted("%.2g", settings_.learning_rate), "", "at most"}})) {
            std::printf("  %s\n", page.c_str());
        }
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
                                    {"threads", settings_.threads},
                                    {"stages", stages_json(stages_)}};
        AtomicFile file(settings_.json);
        file.write(json.dump(2) + "\n");
        file.commit();
    }

    TrainSettings settings_;
    Variant variant_;
    DatasetFolder data_;
    TrainingSplit split_;
    ThreadExecutor executor_;
    TrainingData loaded_;
    Index num_training_ = 0, num_validation_ = 0;
    std::vector<TrainingStage> stages_;
    std::map<std::string, std::string> notes_;
    bool interrupted_ = false;
};

}  // namespace

void train_model(const TrainSettings& settings) {
    Trainer(settings).run();
}

}  // namespace examples
