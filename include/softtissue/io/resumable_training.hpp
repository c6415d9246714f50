// SPDX-License-Identifier: MIT
/// @file
/// Training with a checkpoint in a file: a process that is killed goes on where it was.
///
/// What        train() that begins from the checkpoint if there is one, and writes it from time to time, when it is cancelled and
///             when it ends.
/// Valid       the result has the bits of a training that was never interrupted. The checkpoint carries a description of all
///             that the training depends on besides its options' length: one that belongs to something else is refused.
/// Refuses     what training_state() and train() refuse, a checkpoint with another description (InvalidInput names the file)
/// Cost        a checkpoint is four times the parameters
/// Tests       tests/unit/io/resumable_training_test.cpp, tests/scenario/resumable_training_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/io/safetensors.hpp>
#include <softtissue/io/training_state_file.hpp>
#include <softtissue/nn/train.hpp>

#include <chrono>
#include <filesystem>
#include <string>

namespace softtissue {

struct CheckpointOptions {
    std::filesystem::path path;
    std::string description;  ///< of model, samples and options
    double seconds = 60;      ///< between checkpoints; 0: after every step
};

/// Trains `state`, or what the checkpoint has instead, to its end.
template <TrainableModel M, class Observer = NoTrainingObserver, Executor E = SequentialExecutor>
TrainingReport train_resumably(M& model, const TrainingOptions& options, const CheckpointOptions& checkpoint,
                               TrainingState<typename M::Scalar>& state, const Observer& observer = {},
                               const E& executor = {}) {
    using S = typename M::Scalar;
    using Clock = std::chrono::steady_clock;
    if (std::filesystem::exists(checkpoint.path)) {
        const SafetensorsFile file = read_safetensors(checkpoint.path);
        require(file.metadata_at("description") == checkpoint.description, file.path(),
                ": belongs to another training (", file.metadata_at("description"), "), expected ",
                checkpoint.description, "; remove it, or choose another name, to begin afresh");
        state = training_state<S>(file);
    }
    const auto save = [&] { write_training_state(checkpoint.path, state, {{"description", checkpoint.description}}); };
    Clock::time_point last = Clock::now();
    const auto watch = [&](const TrainingProgress& progress) {
        const Clock::time_point now = Clock::now();
        if (std::chrono::duration<double>(now - last).count() >= checkpoint.seconds) {
            save();
            last = now;
        }
        return observer(progress);
    };
    const TrainingReport report = train(model, options, state, watch, executor);
    save();
    return report;
}

}  // namespace softtissue
