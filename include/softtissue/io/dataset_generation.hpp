// SPDX-License-Identifier: MIT
/// @file
/// Computes the samples of a data set into its folder: in parallel, in shards, and on from where it was stopped.
///
/// What        generate_dataset(): every sample that is neither finished nor failed, body by body; a thread takes the next body.
/// Contract    the files have the same bytes for any number of threads and shards, and however often it was killed in between.
///             `maker(betas)` gives a ShapedBody<double> or throws InvalidInput where there is none: then its samples fail.
///             `observer(progress)` is called after every sample, one call at a time; false ends after the running samples.
/// Shards      body b belongs to shard b modulo num_shards; shards may run at the same time, on any machine that sees the folder.
///             Two runs of one shard at a time do its work twice, and harm nothing.
/// Refuses     a shard that does not exist, no thread (InvalidInput); a disk that cannot be written.
/// Cost        each thread holds one body with its matrices
/// Tests       tests/unit/io/dataset_generation_test.cpp, tests/scenario/dataset_generation_test.cpp
#pragma once

#if !defined(__cpp_exceptions) && !defined(_CPPUNWIND)
#error "softtissue: io/dataset_generation.hpp needs exceptions; without them, leave it out"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/dataset_folder.hpp>
#include <softtissue/io/file_claim.hpp>
#include <softtissue/io/layered_body_file.hpp>
#include <softtissue/ndg/sample_generator.hpp>
#include <softtissue/ndg/shaped_body.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace softtissue {

struct GenerationOptions {
    int threads = 1;
    Index shard = 0;
    Index num_shards = 1;
    SampleOptions<double> samples = sample_options<double>();
};

/// Counts of the samples of this shard.
struct GenerationProgress {
    Index total = 0;
    Index finished = 0;  // all that are there
    Index failed = 0;
    Index newly_done = 0;  // finished or failed in this run
    Index iterations = 0;  // of Newton's method in this run

    Index remaining() const { return total - finished - failed; }
};

namespace detail {

template <NewtonLinearSolver LinearSolver, class BodyMaker, class Observer>
class DatasetGeneration {
public:
    DatasetGeneration(const DatasetFolder& folder, const BodyMaker& maker, const GenerationOptions& options,
                      const Observer& observer)
        : folder_(folder), maker_(maker), options_(options), observer_(observer) {
        require(options.num_shards >= 1 && options.shard >= 0 && options.shard < options.num_shards, "data set: shard ",
                options.shard, " of ", options.num_shards, ", expected 0 to ", options.num_shards - 1);
    }

    GenerationProgress run() {
        remove_stale_files();
        for (Index b = options_.shard; b < folder_.plan().num_bodies(); b += options_.num_shards) {
            const auto [begin, end] = folder_.plan().samples_of(b);
            for (Index i = begin; i < end; ++i) {
                ++progress_.total;
                progress_.finished += folder_.is_finished(i) ? 1 : 0;
                progress_.failed += folder_.is_failed(i) ? 1 : 0;
            }
        }
        next_body_ = options_.shard;
        const ThreadExecutor workers(options_.threads);
        workers.for_each_range(options_.threads, [&](Index, Index) {
            try {
                work();
            } catch (...) {
                stopped_ = true;
                throw;
            }
        });
        return progress_;
    }

private:
    /// What killed runs have left half written; not what a process that lives is writing.
    void remove_stale_files() const {
        for (const char* name : {"", "bodies", "samples", "failed"}) {
            for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / name)) {
                if (entry.path().filename().string().find(".part") != std::string::npos) {
                    remove_abandoned(entry.path());
                }
            }
        }
    }

    void work() {
        while (!stopped_) {
            const Index body = next_body_.fetch_add(options_.num_shards);
            if (body >= folder_.plan().num_bodies()) {
                return;
            }
            std::vector<Index> samples;
            const auto [begin, end] = folder_.plan().samples_of(body);
            for (Index i = begin; i < end; ++i) {
                if (!folder_.is_finished(i) && !folder_.is_failed(i)) {
                    samples.push_back(i);
                }
            }
            if (!samples.empty()) {
                generate(body, samples);
            }
        }
    }

    void generate(Index number, const std::vector<Index>& samples) {
        std::optional<ShapedBody<double>> body;
        if (std::filesystem::exists(folder_.body_path(number))) {
            body = folder_.body(number);
        } else {
            std::string reason;
            try {
                body = maker_(folder_.plan().bodies[size_t(number)].betas);
            } catch (const InvalidInput& error) {
                reason = std::string("no layered body: ") + error.what();
            }
            if (!body.has_value()) {
                for (const Index i : samples) {
                    folder_.write_failure(i, {{"reason", reason}});
                    report(false, 0);
                }
                return;
            }
            const LayeredBody<double>& mean = folder_.mean_body();
            require(body->layered.mesh.cells == mean.mesh.cells && body->layered.prescribed == mean.prescribed,
                    "data set: the layers of body ", number, " have other cells than those of the mean shape");
            folder_.write_body(number, *body);
        }
        SampleGenerator<double, LinearSolver> generator(*body, folder_.tree(), options_.samples);
        for (size_t k = 0; k < samples.size() && !stopped_; ++k) {
            const PlannedSample& planned = folder_.plan().samples[size_t(samples[k])];
            const Pose<double>& pose = folder_.plan().poses[size_t(planned.pose)].pose;
            GeneratedSample<double> generated = generator.generate(pose);
            const SolveReport<double>& solve = generated.report;
            if (generated.succeeded()) {
                folder_.write(DatasetSample{samples[k], planned.split, planned.body, planned.pose, pose,
                                            folder_.plan().bodies[size_t(number)].betas, std::move(generated.positions),
                                            to_string(solve.status), solve.iterations, solve.filtered_iterations,
                                            generated.num_inverted, solve.energy, generated.rest_energy,
                                            solve.decrement});
            } else {
                folder_.write_failure(samples[k], {{"reason", generated.failure},
                                                   {"iterations", solve.iterations},
                                                   {"energy", solve.energy},
                                                   {"decrement", solve.decrement}});
            }
            report(generated.succeeded(), solve.iterations);
        }
    }

    void report(bool succeeded, int iterations) {
        const std::lock_guard<std::mutex> one_at_a_time(mutex_);
        ++(succeeded ? progress_.finished : progress_.failed);
        ++progress_.newly_done;
        progress_.iterations += iterations;
        if (!observer_(progress_)) {
            stopped_ = true;
        }
    }

    const DatasetFolder& folder_;
    const BodyMaker& maker_;
    const GenerationOptions& options_;
    const Observer& observer_;
    std::atomic<Index> next_body_{0};
    std::atomic<bool> stopped_{false};
    std::mutex mutex_;
    GenerationProgress progress_;
};

}  // namespace detail

/// Computes what is missing of one shard; returns where that stands at the end.
template <NewtonLinearSolver LinearSolver = GaussSeidelCg<double>, class BodyMaker, class Observer>
GenerationProgress generate_dataset(const DatasetFolder& folder, const BodyMaker& maker,
                                    const GenerationOptions& options, const Observer& observer) {
    return detail::DatasetGeneration<LinearSolver, BodyMaker, Observer>(folder, maker, options, observer).run();
}

}  // namespace softtissue
