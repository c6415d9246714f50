// SPDX-License-Identifier: MIT
/// @file
/// Checkpoints of a training in files (.safetensors).
///
/// What        tensors parameters, first_moment, second_moment, best_parameters; training_losses, validation_losses (F64);
///             counts (I64): step, best_step, epoch_samples; sums (F64): best_loss, epoch_loss_sum. Metadata are the caller's:
///             what the training depends on.
/// Valid       reads back every bit, infinities included
/// Refuses     what read_safetensors() refuses, tensors that are missing, of another type or size, negative counts
///             (InvalidInput names file and tensor)
/// Needs       nlohmann-json
/// Tests       tests/unit/io/training_state_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/safetensors.hpp>
#include <softtissue/nn/training_state.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace softtissue {

/// Complete or not at all: a process that is killed while writing leaves the older file.
template <RealScalar S>
void write_training_state(const std::filesystem::path& path, const TrainingState<S>& state,
                          const TensorMetadata& metadata = {}) {
    const std::vector<std::int64_t> counts{state.step, state.best_step, state.epoch_samples};
    const std::vector<double> sums{state.best_loss, state.epoch_loss_sum};
    const auto numbers = [](const auto& values) {
        return StoredTensor::from_values(std::span(values), {Index(values.size())});
    };
    write_safetensors(path,
                      {{"parameters", StoredTensor::from_vector(state.parameters)},
                       {"first_moment", StoredTensor::from_vector(state.first_moment)},
                       {"second_moment", StoredTensor::from_vector(state.second_moment)},
                       {"best_parameters", StoredTensor::from_vector(state.best_parameters)},
                       {"training_losses", numbers(state.training_losses)},
                       {"validation_losses", numbers(state.validation_losses)},
                       {"counts", numbers(counts)},
                       {"sums", numbers(sums)}},
                      metadata);
}

/// The state in a file that has been read already, as whoever looks at its metadata first does.
template <RealScalar S>
TrainingState<S> training_state(const SafetensorsFile& file) {
    const auto stored = [&file](const char* name, TensorType type, Index size) -> const StoredTensor& {
        const StoredTensor& tensor = file.at(name);
        require(tensor.type() == type, tensor.source(), ": is of another type than the training's");
        tensor.require_shape({size});
        return tensor;
    };
    constexpr TensorType type = std::is_same_v<S, float> ? TensorType::f32 : TensorType::f64;
    TrainingState<S> state;
    state.parameters = stored("parameters", type, StoredTensor::any).template vector<S>();
    const Index size = state.parameters.size();
    state.first_moment = stored("first_moment", type, size).template vector<S>();
    state.second_moment = stored("second_moment", type, size).template vector<S>();
    state.best_parameters = stored("best_parameters", type, size).template vector<S>();
    state.training_losses = stored("training_losses", TensorType::f64, StoredTensor::any).template values<double>();
    state.validation_losses =
        stored("validation_losses", TensorType::f64, Index(state.training_losses.size())).template values<double>();
    const StoredTensor& counts = stored("counts", TensorType::i64, 3);
    for (const std::int64_t count : counts.values<std::int64_t>()) {
        require(count >= 0, counts.source(), ": holds ", count, ", expected no negative number");
    }
    state.step = Index(counts.values<std::int64_t>()[0]);
    state.best_step = Index(counts.values<std::int64_t>()[1]);
    state.epoch_samples = Index(counts.values<std::int64_t>()[2]);
    const std::vector<double> sums = stored("sums", TensorType::f64, 2).template values<double>();
    state.best_loss = sums[0];
    state.epoch_loss_sum = sums[1];
    return state;
}

template <RealScalar S>
TrainingState<S> read_training_state(const std::filesystem::path& path) {
    return training_state<S>(read_safetensors(path));
}

}  // namespace softtissue
