// SPDX-License-Identifier: MIT
#include "generate.hpp"

#include "../support/embedded_human.hpp"
#include "../support/progress.hpp"
#include "../support/shard.hpp"
#include "compute_samples.hpp"
#include "inputs.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/fingerprint.hpp>
#include <softtissue/ndg/make_dataset_plan.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace examples {

namespace {

using namespace softtissue;

struct GenerateSettings {
    std::string body;
    std::vector<std::string> motions, test_motions;
    std::string scale = "small", out = "ndg_data", shard, json;
    DatasetOptions data;
    Index shapes = 10;
    int threads = 1;
    Index limit = 0;
};

/// All that the files of the data set depend on.
nlohmann::ordered_json definition(const SmplBody<double>& body, const std::vector<DatasetClip>& clips, Index shapes,
                                  const DatasetOptions& data, const SampleOptions<double>& samples) {
    nlohmann::ordered_json json{{"kind", "posed layered bodies"},
                                {"seed", data.seed},
                                {"samples", data.samples},
                                {"bodies", data.bodies},
                                {"poses", data.poses},
                                {"outlier_samples", data.outlier_samples},
                                {"outlier_bodies", data.outlier_bodies},
                                {"body", Fingerprint().add(body).text()},
                                {"shapes",
                                 {{"coefficients", shapes},
                                  {"deviation", data.shape_deviation},
                                  {"limit", data.shape_limit},
                                  {"outlier_deviation", data.outlier_deviation},
                                  {"outlier_limit", data.outlier_limit}}},
                                {"sampling",
                                 {{"noise", data.noise},
                                  {"mixed_share", data.mixed_share},
                                  {"leg_joints", data.leg_joints},
                                  {"candidates_per_pose", data.candidates_per_pose},
                                  {"gap", data.gap}}}};
    for (const DatasetClip& clip : clips) {
        json["motions"].push_back({{"name", clip.name},
                                   {"frames", clip.motion.num_frames()},
                                   {"held_out", clip.held_out},
                                   {"content", Fingerprint().add(clip.motion).text()}});
    }
    const FleshParameters<double>& flesh = samples.flesh;
    json["flesh"] = {{"muscle", {flesh.muscle.young_modulus, flesh.muscle.poisson_ratio}},
                     {"fat", {flesh.fat.young_modulus, flesh.fat.poisson_ratio}},
                     {"stretch", flesh.stretch},
                     {"bending", flesh.bending}};
    json["newton"] = {{"decrement_tolerance", samples.newton.decrement_tolerance},
                      {"max_iterations", samples.newton.max_iterations}};
    return json;
}

/// Each of several shards writes its own file.
void write_json(const GenerateSettings& settings, const Shard& shard, const DatasetFolder& folder,
                const GenerationProgress& progress, double elapsed) {
    if (settings.json.empty()) {
        return;
    }
    nlohmann::ordered_json json{{"folder", settings.out},
                                {"shard", shard.index},
                                {"shards", shard.count},
                                {"samples", progress.total},
                                {"finished", progress.finished},
                                {"failed", progress.failed},
                                {"newly_done", progress.newly_done},
                                {"newton_iterations", progress.iterations},
                                {"seconds", elapsed},
                                {"threads", settings.threads}};
    for (const DatasetSplit split : all_dataset_splits) {
        json["splits"][to_string(split)] = folder.finished(split).size();
    }
    AtomicFile file(settings.json + (shard.count > 1 ? "." + std::to_string(shard.index) : ""));
    file.write(json.dump(2) + "\n");
    file.commit();
}

void print_outcome(const GenerateSettings& settings, const DatasetFolder& folder, const GenerationProgress& progress,
                   double elapsed) {
    std::printf("%s: %td of %td samples, %td failed", settings.out.c_str(), progress.finished, progress.total,
                progress.failed);
    for (const DatasetSplit split : all_dataset_splits) {
        std::printf(", %s %zu", to_string(split), folder.finished(split).size());
    }
    std::printf("\n");
    if (progress.newly_done > 0) {
        std::printf("%td new in %.0f s, %.2f s each, %.1f Newton iterations each\n", progress.newly_done, elapsed,
                    elapsed / double(progress.newly_done), double(progress.iterations) / double(progress.newly_done));
    }
    for (const Index i : folder.failed()) {  // in all shards
        std::printf("failed: sample %td (%s): %s\n", i, to_string(folder.plan().samples[size_t(i)].split),
                    folder.failure(i).c_str());
    }
    if (progress.remaining() > 0) {
        std::printf("%td samples remain: the same command goes on with them\n", progress.remaining());
    }
}

void generate(const GenerateSettings& settings) {
    const MpiShard mpi;
    const Shard shard = settings.shard.empty() ? mpi.shard() : parse_shard(settings.shard);
    watch_interrupt();
    const SmplBody<double> body = read_human(settings.body);
    const std::vector<DatasetClip> clips = read_clips(settings.motions, settings.test_motions, body.num_joints());
    const Index shapes = std::min(settings.shapes, body.num_shapes());
    GenerationOptions options{.threads = settings.threads, .shard = shard.index, .num_shards = shard.count};
    const nlohmann::ordered_json wanted = definition(body, clips, shapes, settings.data, options.samples);
    const SkeletalLayers<double> skeleton{{}, body.tree, body.joint_names};
    const BodyFunction maker = layered_bodies(body);
    mpi.first_alone([&] {
        if (!DatasetFolder::has_plan(settings.out)) {
            SkeletalLayers<double> mean = skeleton;
            mean.body = maker(VectorX<double>::Zero(shapes));
            DatasetFolder::create(settings.out, wanted,
                                  make_dataset_plan(clips, shapes, settings.data, ThreadExecutor(settings.threads)),
                                  mean);
        }
    });
    const DatasetFolder folder(settings.out);
    folder.require_definition(wanted);
    const double begin = seconds();
    std::unique_ptr<Progress> line;
    const auto watch = [&](const GenerationProgress& progress) {
        if (line == nullptr) {
            line = std::make_unique<Progress>("samples", int(progress.remaining() + progress.newly_done));
        }
        line->update(int(progress.newly_done));
        return !is_interrupted() && progress.newly_done != settings.limit;
    };
    const GenerationProgress progress = compute_samples(folder, maker, options, watch);
    print_outcome(settings, folder, progress, seconds() - begin);
    write_json(settings, shard, folder, progress, seconds() - begin);
}

}  // namespace

void add_generate(CLI::App& app) {
    const auto settings = std::make_shared<GenerateSettings>();
    DatasetOptions& data = settings->data;
    CLI::App* const command = app.add_subcommand(
        "generate",
        "Equilibria of bodies in poses, in a folder. Stopped in any way, the same command goes on. Without options: "
        "the embedded body and motion.");
    command->add_option("--body", settings->body, "body in SMPL's layout (.npz)");
    command->add_option("--motion", settings->motions, "motions in AMASS's layout (.npz), cut into blocks of time");
    command->add_option("--test-motion", settings->test_motions, "motions for the test alone");
    const auto count = [&](const char* name, Index& value, const char* description) {
        return command->add_option(name, value, description);
    };
    CLI::Option* const samples = count("--samples", data.samples, "for training, validation and test (default: 600)");
    CLI::Option* const bodies = count("--bodies", data.bodies, "their bodies (default: a quarter of the samples)");
    CLI::Option* const poses = count("--poses", data.poses, "their poses; 0, the default: one for each sample");
    CLI::Option* const outlier_samples =
        count("--outlier-samples", data.outlier_samples,
              "samples of shapes far outside the training's (default: a twentieth of the others)");
    CLI::Option* const outlier_bodies =
        count("--outlier-bodies", data.outlier_bodies, "their bodies (default: half as many)");
    command->add_option("--shapes", settings->shapes, "shape coefficients to vary")->capture_default_str();
    command->add_option("--seed", data.seed, "seed")->capture_default_str();
    command->add_option("--out", settings->out, "folder of the data set")->capture_default_str();
    command->add_option("--threads", settings->threads, "samples at a time; the files do not depend on it")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--shard", settings->shard,
                        "i/n: the i-th (from 0) of n parts of the work; default: MPI's rank");
    command->add_option("--limit", settings->limit, "stop after so many samples; 0: no limit")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_option("--scale", settings->scale, "sizes where no others are given")
        ->check(CLI::IsMember({"small", "paper"}))
        ->capture_default_str();
    command->add_option("--json", settings->json, "file for counts and times; of shard i of several: FILE.i");
    command->callback([=] {
        const bool is_paper = settings->scale == "paper";  // Nolte et al. 2026, sec. 4.1
        const auto fill = [](const CLI::Option* option, Index& value, Index otherwise) {
            value = option->count() > 0 ? value : otherwise;
        };
        DatasetOptions& sizes = settings->data;
        fill(samples, sizes.samples, is_paper ? 25000 : 600);
        fill(bodies, sizes.bodies, is_paper ? 1500 : std::max<Index>(5, sizes.samples / 4));
        fill(poses, sizes.poses, is_paper ? 15000 : 0);
        fill(outlier_samples, sizes.outlier_samples, sizes.samples / 20);
        fill(outlier_bodies, sizes.outlier_bodies, (sizes.outlier_samples + 1) / 2);
        generate(*settings);
    });
}

}  // namespace examples
