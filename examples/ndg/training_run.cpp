// SPDX-License-Identifier: MIT
#include "training_run.hpp"

#include "../support/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace examples {

namespace {

/// Rewrites one line on a terminal; elsewhere prints a line at the end of an epoch.
class EpochLine {
public:
    EpochLine(const std::string& name, const TrainingState<float>& state) : name_(name), state_(state) {}

    void update(const TrainingProgress& progress) {
        const double now = seconds();
        if (first_step_ < 0) {
            first_step_ = progress.step - 1;
        }
        const bool is_terminal = isatty(STDERR_FILENO) != 0;
        const bool is_last = progress.step == progress.num_steps;
        if (!(is_terminal ? now - last_ > 0.2 : progress.is_end_of_epoch) && !is_last) {
            return;
        }
        last_ = now;
        const double remaining =
            (now - start_) / double(progress.step - first_step_) * double(progress.num_steps - progress.step);
        const bool has_epoch = !state_.validation_losses.empty();
        std::fprintf(stderr, "%s%s: epoch %d/%d, step %d, loss %.4g", is_terminal ? "\r" : "", name_.c_str(),
                     int(progress.epoch) + 1, int(progress.epochs), int(progress.step), progress.loss);
        if (has_epoch) {
            std::fprintf(stderr, ", validation %.4g, best %.4g", state_.validation_losses.back(), state_.best_loss);
        }
        std::fprintf(stderr, ", %.0f s left   %s", remaining, is_terminal && !is_last ? "" : "\n");
        std::fflush(stderr);
    }

private:
    std::string name_;
    const TrainingState<float>& state_;
    double start_ = seconds(), last_ = 0.0;
    Index first_step_ = -1;
};

template <class Loss>
TrainingReport run(const TrainingRun& run, const MlpLayers<float>& layers, const Loss& loss,
                   const NetworkSamples<float>& training, const NetworkSamples<float>& validation,
                   TrainingState<float>& state, const ThreadExecutor& executor) {
    NetworkTraining<Loss, ThreadExecutor> model(layers, loss, training, validation, run.options.batch, executor);
    EpochLine line(run.name, state);
    const auto watch = [&](const TrainingProgress& progress) {
        line.update(progress);
        return !is_interrupted();
    };
    return train_resumably(model, run.options, run.checkpoint, state, watch, executor);
}

}  // namespace

TrainingReport run_training(const TrainingRun& settings, const MlpLayers<float>& layers,
                            const GradientLoss<float>& loss, const NetworkSamples<float>& training,
                            const NetworkSamples<float>& validation, TrainingState<float>& state,
                            const ThreadExecutor& executor) {
    return run(settings, layers, loss, training, validation, state, executor);
}

TrainingReport run_training(const TrainingRun& settings, const MlpLayers<float>& layers,
                            const CoefficientLoss<float>& loss, const NetworkSamples<float>& training,
                            const NetworkSamples<float>& validation, TrainingState<float>& state,
                            const ThreadExecutor& executor) {
    return run(settings, layers, loss, training, validation, state, executor);
}

double mean_gradient_loss(const Mlp<float>& mlp, const NetworkSamples<float>& samples, Index batch,
                          const ThreadExecutor& executor) {
    NetworkTraining<GradientLoss<float>, ThreadExecutor> model(mlp.layers(), {}, samples, samples, batch, executor);
    return double(model.validation_loss(mlp.parameters()));
}

}  // namespace examples
