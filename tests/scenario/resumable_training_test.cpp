// SPDX-License-Identifier: MIT
// A training that is killed twenty times at random moments ends with the bits of one that was left alone.
#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/resumable_training.hpp>
#include <softtissue/ndg/gradient_loss.hpp>
#include <softtissue/ndg/network_training.hpp>
#include <softtissue/nn/mlp.hpp>

#include <support/catch.hpp>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

using namespace softtissue;

namespace {

constexpr Index num_inputs = 20, num_cells = 400;

NetworkSamples<float> random_samples(Index count, std::uint64_t seed) {
    RandomGenerator random(seed);
    NetworkSamples<float> samples{MatrixX<float>(num_inputs, count), MatrixX<float>(9 * num_cells, count)};
    for (float& x : samples.inputs.reshaped()) {
        x = float(random.normal());
    }
    for (Index k = 0; k < samples.targets.size(); ++k) {
        samples.targets.reshaped()(k) = float(k % 9 % 4 == 0 ? 1 : 0) + 0.1F * float(random.normal());
    }
    return samples;
}

/// Ten epochs of five steps.
void train_to_the_end(const std::filesystem::path& checkpoint, int threads) {
    const NetworkSamples<float> training = random_samples(40, 1), validation = random_samples(8, 2);
    Mlp<float> mlp({.inputs = num_inputs, .hidden = {32, 16}, .outputs = 9 * num_cells});
    mlp.initialize(3, 0.1F);
    const ThreadExecutor executor(threads);
    NetworkTraining<GradientLoss<float>, ThreadExecutor> model(mlp.layers(), {}, training, validation, 8, executor);
    TrainingOptions options{.epochs = 10, .batch = 8, .seed = 5};
    options.schedule = {5, 0.1};
    TrainingState<float> state(mlp.parameters());
    const auto slowly = [](const TrainingProgress&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return true;
    };
    static_cast<void>(train_resumably(model, options, {checkpoint, "random samples", 0}, state, slowly, executor));
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Of a process that trains.
pid_t start_training(const std::filesystem::path& checkpoint, int threads) {
    const pid_t child = fork();
    if (child == 0) {
        train_to_the_end(checkpoint, threads);
        _exit(0);
    }
    return child;
}

}  // namespace

TEST_CASE("killed twenty times, the training ends as if nothing had happened", "[training]") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "softtissue_resumable_training_scenario";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::filesystem::path alone = folder / "alone.safetensors", killed = folder / "killed.safetensors";
    RandomGenerator random(17);
    int kills = 0, status = 0;
    for (bool finished = false; !finished;) {  // forks before this process has threads of its own
        const pid_t child = start_training(killed, 1 + kills % 2);
        if (kills < 20) {
            std::this_thread::sleep_for(std::chrono::microseconds(long(random.uniform(2e3, 3e4))));
            kill(child, SIGKILL);
        }
        REQUIRE(waitpid(child, &status, 0) == child);
        finished = WIFEXITED(status);
        kills += finished ? 0 : 1;
    }
    REQUIRE(WEXITSTATUS(status) == 0);
    const pid_t child = start_training(alone, 1);
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE((WIFEXITED(status) && WEXITSTATUS(status) == 0));

    WARN("killed " << kills << " times");
    CHECK(kills >= 10);  // a fast machine may finish before the last ones
    const TrainingState<float> state = read_training_state<float>(killed);
    CHECK(state.step == 50);
    CHECK(state.validation_losses.size() == 10);
    CHECK(state.validation_losses.back() < state.validation_losses.front());
    CHECK((bytes_of(killed) == bytes_of(alone)));
    std::filesystem::remove_all(folder);
}
