// SPDX-License-Identifier: MIT
#include <softtissue/ndg/network_training.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/ndg/coefficient_loss.hpp>
#include <softtissue/ndg/gradient_loss.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/train.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

static_assert(TrainableModel<NetworkTraining<GradientLoss<float>>>);
static_assert(TrainableModel<NetworkTraining<CoefficientLoss<double>, ThreadExecutor>>);

namespace {

constexpr Index num_inputs = 7, num_cells = 5;

template <class S>
MatrixX<S> random_matrix(Index rows, Index cols, S size, RandomGenerator& random) {
    return MatrixX<S>::NullaryExpr(rows, cols, [&](Index, Index) { return size * S(random.normal()); });
}

/// Gradients near the identity.
template <class S>
NetworkSamples<S> random_samples(Index count, std::uint64_t seed) {
    RandomGenerator random(seed);
    NetworkSamples<S> samples{random_matrix<S>(num_inputs, count, S(1), random),
                              random_matrix<S>(9 * num_cells, count, S(0.2), random)};
    for (Index row = 0; row < samples.targets.rows(); ++row) {
        samples.targets.row(row).array() += S(row % 9 % 4 == 0 ? 1 : 0);
    }
    return samples;
}

template <class S>
Mlp<S> random_network() {
    Mlp<S> mlp({.inputs = num_inputs, .hidden = {12, 6}, .outputs = 9 * num_cells});
    mlp.initialize(5);
    return mlp;
}

const std::vector<std::int32_t> batch{4, 0, 2};

}  // namespace

TEST_CASE("the derivative of the training loss by the weights, by Taylor rate") {
    const NetworkSamples<double> training = random_samples<double>(6, 1), validation = random_samples<double>(2, 2);
    const Mlp<double> mlp = random_network<double>();
    const SequentialExecutor executor;
    RandomGenerator random(3);
    const VectorX<double> direction = 0.3 * random_matrix<double>(mlp.parameters().size(), 1, 1.0, random);
    for (const bool exponential : {true, false}) {
        NetworkTraining<GradientLoss<double>> model(mlp.layers(), {exponential}, training, validation, 4, executor);
        VectorX<double> gradient, ignored;
        model.loss_and_gradient(mlp.parameters(), batch, gradient);
        const auto along = [&](double h) {
            return model.loss_and_gradient(mlp.parameters() + h * direction, batch, ignored);
        };
        CHECK(taylor_rate(along, gradient.dot(direction)).is_at_least(2));
        CHECK_FALSE(taylor_rate(along, 1.01 * gradient.dot(direction)).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("the loss of a batch is the mean of its samples' losses; threads change no bit", S, float, double) {
    const NetworkSamples<S> training = random_samples<S>(6, 1), validation = random_samples<S>(5, 2);
    const Mlp<S> mlp = random_network<S>();
    const SequentialExecutor executor;
    NetworkTraining<GradientLoss<S>> model(mlp.layers(), {}, training, validation, 3, executor);
    CHECK(model.num_samples() == 6);
    CHECK(model.num_parameters() == mlp.parameters().size());
    VectorX<S> gradient, single, sum = VectorX<S>::Zero(mlp.parameters().size());
    const S loss = model.loss_and_gradient(mlp.parameters(), batch, gradient);
    S mean(0);
    for (const std::int32_t sample : batch) {
        mean += model.loss_and_gradient(mlp.parameters(), std::vector<std::int32_t>{sample}, single) / S(3);
        sum += single / S(3);
    }
    const S tolerance = S(100) * std::numeric_limits<S>::epsilon();
    CHECK(std::abs(loss - mean) < tolerance);
    CHECK((gradient - sum).cwiseAbs().maxCoeff() < tolerance);

    // more samples than a batch holds
    NetworkTraining<GradientLoss<S>> whole(mlp.layers(), {}, training, validation, 5, executor);
    CHECK(std::abs(model.validation_loss(mlp.parameters()) - whole.validation_loss(mlp.parameters())) < tolerance);
    CHECK(model.mean_loss(mlp.parameters(), training) ==
          doctest::Approx(double(model.mean_loss(mlp.parameters(), training))));

    const ThreadExecutor threads(3);
    NetworkTraining<GradientLoss<S>, ThreadExecutor> with_threads(mlp.layers(), {}, training, validation, 3, threads);
    CHECK(with_threads.loss_and_gradient(mlp.parameters(), batch, single) == loss);
    CHECK(single == gradient);
    CHECK(with_threads.validation_loss(mlp.parameters()) == model.validation_loss(mlp.parameters()));
}

TEST_CASE("samples that do not fit or are not finite are refused") {
    NetworkSamples<double> training = random_samples<double>(6, 1);
    const NetworkSamples<double> validation = random_samples<double>(5, 2), none;
    const Mlp<double> mlp = random_network<double>();
    const SequentialExecutor executor;
    const auto make = [&](const NetworkSamples<double>& used, Index max_batch) {
        NetworkTraining<GradientLoss<double>>(mlp.layers(), {}, used, validation, max_batch, executor);
    };
    CHECK_THROWS_WITH_AS(make(training, 0), "network training: batches of 0 samples, expected at least 1",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(make(none, 3), "network training: no training samples", InvalidInput);
    training.targets(3, 4) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(make(training, 3), "network training: training sample 4 is not finite", InvalidInput);
    training.inputs.resize(6, 6);
    CHECK_THROWS_WITH_AS(make(training, 3),
                         "network training: training inputs of 6 numbers, expected 7, for 6 targets, expected 6",
                         InvalidInput);
}
