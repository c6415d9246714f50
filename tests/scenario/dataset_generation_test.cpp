// SPDX-License-Identifier: MIT
// A data set whose making is killed again and again, from the plan to the last sample, is the one that was never disturbed.
#include <softtissue/core/random.hpp>
#include <softtissue/io/dataset_generation.hpp>

#include <support/catch.hpp>
#include <support/limb_dataset.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <thread>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// The bytes of all files below a folder, by their relative names.
std::map<std::string, std::string> all_files(const std::filesystem::path& path) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) {
            std::ifstream stream(entry.path(), std::ios::binary);
            files[std::filesystem::relative(entry.path(), path).string()] = {std::istreambuf_iterator<char>(stream),
                                                                             std::istreambuf_iterator<char>()};
        }
    }
    return files;
}

/// What a program that makes data sets does, from nothing or from where it was stopped.
void make_dataset(const std::filesystem::path& path, int threads) {
    DatasetOptions options = limb_options();
    options.samples = 60;
    options.bodies = 20;
    if (!DatasetFolder::has_plan(path)) {
        create_limb_dataset(path, limb_plan(options));
    }
    const DatasetFolder folder(path);
    static_cast<void>(
        generate_dataset(folder, LimbMaker(), {.threads = threads}, [](const GenerationProgress&) { return true; }));
}

/// A process of its own that makes a data set.
pid_t start_making(const std::filesystem::path& path) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        try {
            make_dataset(path, 2);
        } catch (const std::exception&) {
            _exit(1);
        }
        _exit(0);
    }
    return child;
}

/// Makes a data set in a process that is killed after a while; whether that came before its end.
bool is_killed_while_making(const std::filesystem::path& path, double milliseconds) {
    const pid_t child = start_making(path);
    std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(milliseconds));
    kill(child, SIGKILL);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return WIFSIGNALED(status);
}

}  // namespace

TEST_CASE("a data set is the same, byte for byte, after twenty kills at random moments", "[dataset]") {
    const std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("softtissue_dataset_" + std::to_string(getpid()));
    std::filesystem::create_directories(root);
    const auto begin = std::chrono::steady_clock::now();
    make_dataset(root / "whole", 1);
    const double duration = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const auto whole = all_files(root / "whole");
    CHECK(whole.size() > 60);

    RandomGenerator random(20);
    int kills = 0, folders = 0;
    for (int attempt = 0; kills < 20 && attempt < 200; ++attempt) {
        const std::filesystem::path path = root / std::to_string(folders);
        if (is_killed_while_making(path, random.uniform(0.0, 0.15 * duration))) {
            ++kills;
        } else {
            CHECK(all_files(path) == whole);
            ++folders;
        }
    }
    CHECK(kills == 20);
    make_dataset(root / std::to_string(folders), 1);
    CHECK(all_files(root / std::to_string(folders)) == whole);
    std::filesystem::remove_all(root);
}

TEST_CASE("three processes that make one data set at once make the same files", "[dataset]") {
    const std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("softtissue_datasets_" + std::to_string(getpid()));
    std::filesystem::create_directories(root);
    make_dataset(root / "whole", 1);
    for (int repetition = 0; repetition < 2; ++repetition) {
        const std::filesystem::path path = root / std::to_string(repetition);
        for (int process = 0; process < 3; ++process) {
            static_cast<void>(start_making(path));
        }
        int status = 0;
        for (int process = 0; process < 3; ++process) {
            REQUIRE(wait(&status) > 0);
            CHECK(status == 0);
        }
        CHECK(all_files(path) == all_files(root / "whole"));
    }
    std::filesystem::remove_all(root);
}
