// SPDX-License-Identifier: MIT
/// @file
/// Training of anything that has parameters, samples and a loss.
///
/// What        epochs of mini-batches with AdamW, a learning-rate schedule, and early stopping on the validation loss
/// Order       every epoch takes all training samples once, in an order that depends on (seed, epoch) alone; the last batch
///             of an epoch may be smaller
/// Resuming    train() goes on from any state, and the bits are those of a training that was never interrupted. A state that
///             is at its end, or past its patience, returns at once.
/// Refuses     a state of another size or of another number of samples a batch; empty training sets (InvalidInput)
/// Outcomes    are values: finished, early_stopped, cancelled, not_finite. A step whose loss or gradient is not finite is
///             not taken: the state is that of the step before.
/// Tests       tests/unit/nn/train_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/adamw.hpp>
#include <softtissue/nn/layer_norm.hpp>
#include <softtissue/nn/learning_rate.hpp>
#include <softtissue/nn/training_state.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace softtissue {

/// loss_and_gradient: the mean loss over the given training samples; overwrites the gradient. Equal arguments give equal
/// bits. validation_loss: the mean over samples that are not trained on.
template <class M>
concept TrainableModel = RealScalar<typename M::Scalar> &&
    requires(M& model, const VectorX<typename M::Scalar>& parameters, std::span<const std::int32_t> samples,
             VectorX<typename M::Scalar>& gradient) {
    { model.num_parameters() } -> std::same_as<Index>;
    { model.num_samples() } -> std::same_as<Index>;
    { model.loss_and_gradient(parameters, samples, gradient) } -> std::same_as<typename M::Scalar>;
    { model.validation_loss(parameters) } -> std::same_as<typename M::Scalar>;
};

struct TrainingOptions {
    Index epochs = 100;
    Index batch = 32;
    AdamWOptions optimizer = {};
    LearningRateSchedule schedule = {};
    Index patience = 0;  ///< epochs without a better validation loss after which to stop; 0: never
    std::uint64_t seed = 0;
};

enum class TrainingStatus {
    finished,       ///< all epochs are done
    early_stopped,  ///< the validation loss has not improved for `patience` epochs
    cancelled,      ///< the observer asked to stop
    not_finite,     ///< a loss or gradient is not finite
};

/// The status in words.
constexpr const char* to_string(TrainingStatus status) {
    switch (status) {
        case TrainingStatus::finished:
            return "finished";
        case TrainingStatus::early_stopped:
            return "stopped early: no better validation loss";
        case TrainingStatus::cancelled:
            return "cancelled";
        case TrainingStatus::not_finite:
            return "loss or gradient is not finite";
    }
    return "unknown";
}

struct [[nodiscard]] TrainingReport {
    TrainingStatus status = TrainingStatus::finished;
    Index step = 0;            ///< updates done in all
    double training_loss = 0;  ///< of the last step taken; 0 if there was none
    double learning_rate = 0;  ///< of the last step taken
};

/// What an observer sees after each step, when the state is a complete checkpoint; it returns false to cancel.
struct TrainingProgress {
    Index epoch = 0, epochs = 0;    ///< the epoch of the step, from 0
    Index step = 0, num_steps = 0;  ///< updates done, and in all epochs
    double loss = 0;                ///< of the step's batch, before the step
    double learning_rate = 0;
    bool is_end_of_epoch = false;  ///< then the state's last losses are those of this epoch
};

struct NoTrainingObserver {
    bool operator()(const TrainingProgress&) const { return true; }
};

namespace detail {

/// Orders of the samples, one epoch at a time.
class SampleOrder {
public:
    SampleOrder(Index samples, std::uint64_t seed) : order_(size_t(samples)), seed_(seed) {}

    std::span<const std::int32_t> batch(Index epoch, Index first, Index count) {
        if (epoch != epoch_) {
            std::iota(order_.begin(), order_.end(), 0);
            RandomGenerator random(seed_ + 0xd1342543de82ef95U * std::uint64_t(epoch + 1));
            random.shuffle(std::span<std::int32_t>(order_));
            epoch_ = epoch;
        }
        return std::span<const std::int32_t>(order_).subspan(size_t(first), size_t(count));
    }

private:
    std::vector<std::int32_t> order_;
    std::uint64_t seed_;
    Index epoch_ = -1;
};

template <RealScalar S>
bool is_finite(const VectorX<S>& v) {
    return lane_sum<S>(v.size(), [x = v.data()](Index i) { return x[i] * S(0); }) == S(0);
}

template <RealScalar S>
void require_resumable(const TrainingState<S>& state, Index parameters, Index samples, Index steps_per_epoch,
                       const TrainingOptions& options) {
    options.optimizer.validate();
    options.schedule.validate();
    require(options.epochs >= 0 && options.batch >= 1 && options.patience >= 0, "training: epochs = ", options.epochs,
            ", batch = ", options.batch, ", patience = ", options.patience, ", expected >= 0, >= 1, >= 0");
    for (const VectorX<S>* vector :
         {&state.parameters, &state.first_moment, &state.second_moment, &state.best_parameters}) {
        require(vector->size() == parameters, "training state: ", vector->size(), " parameters, expected ", parameters);
    }
    const Index epochs = state.step / steps_per_epoch, in_epoch = state.step % steps_per_epoch;
    require(state.step >= 0 && Index(state.training_losses.size()) == epochs &&
                Index(state.validation_losses.size()) == epochs && state.epoch_samples == in_epoch * options.batch,
            "training state: ", state.step, " steps, ", state.training_losses.size(), " epochs and ",
            state.epoch_samples, " samples, expected ", epochs, " epochs and ", in_epoch * options.batch,
            " samples of ", samples, " in batches of ", options.batch);
}

}  // namespace detail

/// Trains from `state` on, which is a complete checkpoint whenever the observer is called and when train() returns.
template <TrainableModel M, class Observer = NoTrainingObserver, Executor E = SequentialExecutor>
TrainingReport train(M& model, const TrainingOptions& options, TrainingState<typename M::Scalar>& state,
                     const Observer& observer = {}, const E& executor = {}) {
    using S = typename M::Scalar;
    const Index samples = model.num_samples();
    require(samples >= 1, "training: ", samples, " samples, expected at least one");
    const Index steps_per_epoch = (samples + options.batch - 1) / std::max(options.batch, Index(1));
    const Index num_steps = options.epochs * steps_per_epoch;
    detail::require_resumable(state, model.num_parameters(), samples, steps_per_epoch, options);
    detail::SampleOrder order(samples, options.seed);
    VectorX<S> gradient(model.num_parameters());
    TrainingReport report;
    const auto ended = [&](TrainingStatus status) {
        report.status = status;
        report.step = state.step;
        return report;
    };
    const auto is_past_patience = [&] {
        return options.patience > 0 && state.step - state.best_step >= options.patience * steps_per_epoch &&
               state.step % steps_per_epoch == 0;
    };
    while (state.step < num_steps) {
        if (is_past_patience()) {
            return ended(TrainingStatus::early_stopped);
        }
        const Index epoch = state.step / steps_per_epoch, first = state.step % steps_per_epoch * options.batch;
        const Index count = std::min(options.batch, samples - first);
        const S loss = model.loss_and_gradient(state.parameters, order.batch(epoch, first, count), gradient);
        require(gradient.size() == state.parameters.size(), "training: gradient of ", gradient.size(),
                " entries, expected ", state.parameters.size());
        if (!std::isfinite(loss) || !detail::is_finite(gradient)) {
            return ended(TrainingStatus::not_finite);
        }
        report.training_loss = double(loss);
        report.learning_rate = options.optimizer.learning_rate * options.schedule.factor(state.step, num_steps);
        adamw_update(options.optimizer, report.learning_rate, state.step + 1, gradient, state.first_moment,
                     state.second_moment, state.parameters, executor);
        ++state.step;
        state.epoch_loss_sum += double(loss) * double(count);
        state.epoch_samples += count;
        const bool is_end_of_epoch = state.step % steps_per_epoch == 0;
        if (is_end_of_epoch) {
            state.training_losses.push_back(state.epoch_loss_sum / double(state.epoch_samples));
            state.epoch_loss_sum = 0;
            state.epoch_samples = 0;
            state.validation_losses.push_back(double(model.validation_loss(state.parameters)));
            if (state.validation_losses.back() < state.best_loss) {
                state.best_loss = state.validation_losses.back();
                state.best_step = state.step;
                state.best_parameters = state.parameters;
            }
        }
        const bool goes_on = observer(TrainingProgress{epoch, options.epochs, state.step, num_steps, double(loss),
                                                       report.learning_rate, is_end_of_epoch});
        if (!goes_on && state.step < num_steps) {
            return ended(TrainingStatus::cancelled);
        }
    }
    return ended(TrainingStatus::finished);
}

}  // namespace softtissue
