// SPDX-License-Identifier: MIT
#include <softtissue/nn/train.hpp>

#include <softtissue/core/thread_executor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>

using namespace softtissue;

namespace {

/// A line through points on a line, by least squares; from `poisoned` calls on the loss is NaN.
template <class S>
struct LineFit {
    using Scalar = S;

    Index samples = 10;
    int calls = 0;
    int poisoned = std::numeric_limits<int>::max();
    bool only_gradient = false;
    std::vector<std::int32_t> seen;
    S validation_offset = S(0);

    Index num_parameters() { return 2; }
    Index num_samples() { return samples; }

    static S x(std::int32_t sample) { return S(sample) / S(10); }

    S loss_and_gradient(const VectorX<S>& p, std::span<const std::int32_t> batch, VectorX<S>& gradient) {
        S loss = 0;
        gradient.setZero();
        for (const std::int32_t sample : batch) {
            seen.push_back(sample);
            const S error = p(0) + p(1) * x(sample) - (S(1) - S(2) * x(sample));
            loss += error * error / S(batch.size());
            gradient += S(2) * error / S(batch.size()) * VectorX<S>{{S(1), x(sample)}};
        }
        if (++calls > poisoned) {
            (only_gradient ? gradient(1) : loss) = std::numeric_limits<S>::quiet_NaN();
        }
        return loss;
    }

    S validation_loss(const VectorX<S>& p) { return std::abs(p(0) - S(1)) + std::abs(p(1) + S(2) + validation_offset); }
};

struct WithoutValidation {
    using Scalar = float;
    Index num_parameters();
    Index num_samples();
    float loss_and_gradient(const VectorX<float>&, std::span<const std::int32_t>, VectorX<float>&);
};

static_assert(TrainableModel<LineFit<float>> && TrainableModel<LineFit<double>>);
static_assert(!TrainableModel<WithoutValidation> && !TrainableModel<int>);

template <class S>
VectorX<S> start() {
    return VectorX<S>{{S(0.3), S(0.4)}};
}

template <class S>
bool same_bits(const TrainingState<S>& a, const TrainingState<S>& b) {
    return a.parameters == b.parameters && a.first_moment == b.first_moment && a.second_moment == b.second_moment &&
           a.best_parameters == b.best_parameters && a.step == b.step && a.best_step == b.best_step &&
           a.best_loss == b.best_loss && a.training_losses == b.training_losses &&
           a.validation_losses == b.validation_losses && a.epoch_loss_sum == b.epoch_loss_sum &&
           a.epoch_samples == b.epoch_samples;
}

const TrainingOptions options{.epochs = 6,
                              .batch = 4,
                              .optimizer = {.learning_rate = 0.05},
                              .schedule = {.warm_up_steps = 2, .final_fraction = 0.1},
                              .seed = 7};

}  // namespace

TEST_CASE_TEMPLATE("finds the line", S, float, double) {
    LineFit<S> model;
    TrainingState<S> state(start<S>());
    const TrainingReport report = train(
        model,
        {.epochs = 800, .batch = 4, .optimizer = {.learning_rate = 0.05, .weight_decay = 0}, .schedule = {0, 0.01}},
        state);
    CHECK(report.status == TrainingStatus::finished);
    CHECK(report.step == 2400);
    CHECK(state.training_losses.size() == 800);
    CHECK(state.training_losses.back() < 1e-6);
    CHECK(std::abs(state.best_parameters(1) + S(2)) < S(1e-3));
    CHECK(state.best_loss <= state.validation_losses.front());
    CHECK(report.learning_rate == doctest::Approx(0.05 * 0.01).epsilon(0.02));
}

TEST_CASE("every epoch sees all samples once, in an order of its own") {
    LineFit<double> model;
    TrainingState<double> state(start<double>());
    std::vector<double> losses;
    const auto observer = [&](const TrainingProgress& progress) {
        losses.push_back(progress.loss);
        CHECK(progress.step == Index(losses.size()));
        CHECK(progress.num_steps == 18);
        CHECK(progress.epoch == (progress.step - 1) / 3);
        CHECK(progress.is_end_of_epoch == (progress.step % 3 == 0));
        return true;
    };
    CHECK(train(model, options, state, observer).status == TrainingStatus::finished);
    REQUIRE(model.seen.size() == 60);
    std::set<std::vector<std::int32_t>> orders;
    for (auto epoch = model.seen.begin(); epoch != model.seen.end(); epoch += 10) {
        orders.insert(std::vector<std::int32_t>(epoch, epoch + 10));
        CHECK(std::set<std::int32_t>(epoch, epoch + 10).size() == 10);
    }
    CHECK(orders.size() == 6);
    // an epoch's loss is the mean over samples: its last batch has two of ten
    CHECK(state.training_losses[0] == doctest::Approx((4 * losses[0] + 4 * losses[1] + 2 * losses[2]) / 10));

    LineFit<double> other;
    TrainingState<double> other_state(start<double>());
    TrainingOptions other_options = options;
    other_options.seed = 8;
    CHECK(train(other, other_options, other_state).status == TrainingStatus::finished);
    CHECK(other.seen != model.seen);
}

TEST_CASE_TEMPLATE("stopped after any step and gone on with, the bits are the same", S, float, double) {
    LineFit<S> model;
    TrainingState<S> expected(start<S>());
    CHECK(train(model, options, expected).status == TrainingStatus::finished);
    for (Index stop = 1; stop < 18; ++stop) {
        TrainingState<S> state(start<S>());
        TrainingState<S> saved;
        const auto until_stop = [&](const TrainingProgress& progress) {
            saved = state;
            return progress.step < stop;
        };
        CHECK(train(model, options, state, until_stop).status == TrainingStatus::cancelled);
        CHECK(saved.step == stop);
        CHECK(same_bits(saved, state));
        CHECK(train(model, options, saved).status == TrainingStatus::finished);
        CHECK(same_bits(saved, expected));
    }
    CHECK(train(model, options, expected).status == TrainingStatus::finished);  // at its end: nothing happens
    CHECK(expected.step == 18);
    TrainingState<S> parallel(start<S>());
    CHECK(train(model, options, parallel, NoTrainingObserver{}, ThreadExecutor(2)).status == TrainingStatus::finished);
    CHECK(same_bits(parallel, expected));
}

TEST_CASE("stops when the validation loss gets no better, and keeps the best parameters") {
    LineFit<double> model;
    model.validation_offset = -1.5;  // passed on the way from the start to the line
    TrainingOptions patient = options;
    patient.epochs = 500;
    patient.patience = 5;
    TrainingState<double> state(start<double>());
    const TrainingReport report = train(model, patient, state);
    CHECK(report.status == TrainingStatus::early_stopped);
    CHECK(state.step == state.best_step + 15);
    CHECK(state.step < 1500);
    CHECK(state.best_loss == state.validation_losses[size_t(state.best_step / 3 - 1)]);
    CHECK(model.validation_loss(state.best_parameters) == state.best_loss);
    CHECK(model.validation_loss(state.parameters) > state.best_loss);
    const TrainingState<double> before = state;
    CHECK(train(model, patient, state).status == TrainingStatus::early_stopped);
    CHECK(same_bits(state, before));
}

TEST_CASE_TEMPLATE("a step whose loss or gradient is not finite is not taken", S, float, double) {
    for (const bool only_gradient : {false, true}) {
        LineFit<S> model, clean;
        model.poisoned = 7;
        model.only_gradient = only_gradient;
        TrainingState<S> state(start<S>()), expected = state;
        CHECK(train(model, options, state).status == TrainingStatus::not_finite);
        CHECK(state.step == 7);
        const auto until_seven = [](const TrainingProgress& progress) { return progress.step < 7; };
        CHECK(train(clean, options, expected, until_seven).status == TrainingStatus::cancelled);
        CHECK(same_bits(state, expected));
    }
}

TEST_CASE("states and options that do not fit are refused") {
    LineFit<double> model;
    TrainingState<double> state(start<double>()), other(VectorX<double>::Zero(3));
    const auto run = [&](const TrainingOptions& with, TrainingState<double>& from) {
        return train(model, with, from).status;
    };
    CHECK_THROWS_WITH_AS(run(options, other), "training state: 3 parameters, expected 2", InvalidInput);
    CHECK_THROWS_AS(run({.batch = 0}, state), InvalidInput);
    CHECK_THROWS_AS(run({.optimizer = {.beta1 = 2}}, state), InvalidInput);
    CHECK_THROWS_AS(run({.schedule = {.warm_up_steps = -2}}, state), InvalidInput);
    const auto after_four = [](const TrainingProgress& progress) { return progress.step < 4; };
    CHECK(train(model, options, state, after_four).status == TrainingStatus::cancelled);
    TrainingOptions other_batch = options;
    other_batch.batch = 3;
    CHECK_THROWS_WITH_AS(
        run(other_batch, state),
        "training state: 4 steps, 1 epochs and 4 samples, expected 1 epochs and 0 samples of 10 in batches of 3",
        InvalidInput);
    model.samples = 0;
    CHECK_THROWS_WITH_AS(run(options, state), "training: 0 samples, expected at least one", InvalidInput);
    CHECK(std::string(to_string(TrainingStatus::early_stopped)) == "stopped early: no better validation loss");
}
