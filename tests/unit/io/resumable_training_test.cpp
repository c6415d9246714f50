// SPDX-License-Identifier: MIT
#include <softtissue/io/resumable_training.hpp>

#include <doctest/doctest.h>

#include <filesystem>

using namespace softtissue;

namespace {

/// Distances to samples on a line; the noise of mini-batches comes from their order.
struct Points {
    using Scalar = double;

    Index num_parameters() const { return 2; }
    Index num_samples() const { return 7; }
    double loss_and_gradient(const VectorX<double>& p, std::span<const std::int32_t> samples,
                             VectorX<double>& gradient) {
        gradient = VectorX<double>::Zero(2);
        double loss = 0;
        for (const std::int32_t k : samples) {
            const Eigen::Vector2d d = p - Eigen::Vector2d(k, 0.1 * k);
            loss += d.squaredNorm() / double(samples.size());
            gradient += 2 * d / double(samples.size());
        }
        return loss;
    }
    double validation_loss(const VectorX<double>& p) { return (p - Eigen::Vector2d(3, 0.4)).squaredNorm(); }
};

struct Run {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / "softtissue_resumable_training_test.safetensors";
    TrainingOptions options{.epochs = 10, .batch = 2, .optimizer = {.learning_rate = 0.1}, .schedule = {}, .seed = 3};
    CheckpointOptions checkpoint{path, "points", 0};
    TrainingState<double> state{VectorX<double>::Zero(2)};

    /// Cancelled after so many steps.
    TrainingReport train_for(Index steps) {
        Points points;
        state = TrainingState<double>(VectorX<double>::Zero(2));
        return train_resumably(points, options, checkpoint, state,
                               [&steps](const TrainingProgress&) { return --steps > 0; });
    }
};

}  // namespace

TEST_CASE("interrupted anywhere, the result is the same, whether or not the checkpoint is recent") {
    Run whole;
    std::filesystem::remove(whole.path);
    CHECK(whole.train_for(1000).status == TrainingStatus::finished);
    CHECK(whole.state.step == 40);
    for (const double seconds : {0.0, 1e9}) {  // after every step, or only when it ends
        std::filesystem::remove(whole.path);
        Run parts;
        parts.checkpoint.seconds = seconds;
        TrainingReport report;
        int runs = 0;
        do {
            report = parts.train_for(3);
            ++runs;
        } while (report.status == TrainingStatus::cancelled);
        CHECK(runs == 14);
        CHECK(parts.state.parameters == whole.state.parameters);
        CHECK(parts.state.best_parameters == whole.state.best_parameters);
        CHECK(parts.state.training_losses == whole.state.training_losses);
        CHECK(parts.state.validation_losses == whole.state.validation_losses);
        CHECK(parts.train_for(3).status == TrainingStatus::finished);  // nothing left to do
    }
    std::filesystem::remove(whole.path);
}

TEST_CASE("the checkpoint of another training is refused") {
    Run run;
    std::filesystem::remove(run.path);
    CHECK(run.train_for(3).status == TrainingStatus::cancelled);
    run.checkpoint.description = "lines";
    CHECK_THROWS_WITH_AS(
        static_cast<void>(run.train_for(3)),
        (run.path.string() + ": belongs to another training (points), expected lines; remove it, or choose "
                             "another name, to begin afresh")
            .c_str(),
        InvalidInput);
    std::filesystem::remove(run.path);
}
