// SPDX-License-Identifier: MIT
#include <softtissue/io/training_state_file.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;

namespace {

const std::filesystem::path path =
    std::filesystem::temp_directory_path() / "softtissue_training_state_file_test.safetensors";

template <class S>
TrainingState<S> some_state() {
    TrainingState<S> state(VectorX<S>::LinSpaced(7, S(-1) / S(3), S(1)));
    state.first_moment.setConstant(S(0.1));
    state.second_moment(3) = std::numeric_limits<S>::denorm_min();
    state.best_parameters(2) = S(5);
    state.step = 17;
    state.best_step = 10;
    state.best_loss = 0.1;
    state.training_losses = {1.0 / 3, 0.2};
    state.validation_losses = {0.5, 0.1};
    state.epoch_loss_sum = 1e-300;
    state.epoch_samples = 6;
    return state;
}

template <class S>
void check_equal(const TrainingState<S>& a, const TrainingState<S>& b) {
    CHECK(a.parameters == b.parameters);
    CHECK(a.first_moment == b.first_moment);
    CHECK(a.second_moment == b.second_moment);
    CHECK(a.best_parameters == b.best_parameters);
    CHECK(a.step == b.step);
    CHECK(a.best_step == b.best_step);
    CHECK(a.best_loss == b.best_loss);
    CHECK(a.training_losses == b.training_losses);
    CHECK(a.validation_losses == b.validation_losses);
    CHECK(a.epoch_loss_sum == b.epoch_loss_sum);
    CHECK(a.epoch_samples == b.epoch_samples);
}

}  // namespace

TEST_CASE_TEMPLATE("every bit comes back", S, float, double) {
    write_training_state(path, some_state<S>(), {{"description", "d"}});
    check_equal(read_training_state<S>(path), some_state<S>());
    CHECK(read_safetensors(path).metadata_at("description") == "d");
    const TrainingState<S> fresh(VectorX<S>::Ones(3));  // its best loss is infinite
    write_training_state(path, fresh);
    check_equal(read_training_state<S>(path), fresh);
}

TEST_CASE("what is no checkpoint of this precision is refused") {
    const auto message = [](const std::string& name, const StoredTensor& value) -> std::string {
        write_training_state(path, some_state<double>());
        NamedTensors tensors = read_safetensors(path).tensors();
        std::find_if(tensors.begin(), tensors.end(), [&](const auto& item) { return item.first == name; })->second =
            value;
        write_safetensors(path, tensors);
        try {
            read_training_state<double>(path);
        } catch (const InvalidInput& error) {
            return std::string(error.what()).substr(path.string().size());
        }
        return "";
    };
    CHECK(message("first_moment", StoredTensor::from_vector(VectorX<double>::Zero(6))) ==
          ": tensor 'first_moment': shape is (6,), expected (7,)");
    CHECK(message("first_moment", StoredTensor::from_vector(VectorX<float>::Zero(7))) ==
          ": tensor 'first_moment': is of another type than the training's");
    CHECK(message("validation_losses", StoredTensor::from_vector(VectorX<double>::Zero(1))) ==
          ": tensor 'validation_losses': shape is (1,), expected (2,)");
    const std::vector<std::int64_t> negative{1, -1, 0};
    CHECK(message("counts", StoredTensor::from_values(std::span<const std::int64_t>(negative), {3})) ==
          ": tensor 'counts': holds -1, expected no negative number");
    std::filesystem::remove(path);
    CHECK_THROWS_AS(read_training_state<double>(path), InvalidInput);
}
