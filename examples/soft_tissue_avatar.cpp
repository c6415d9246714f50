// SPDX-License-Identifier: MIT
// ctest: --frames 40 --out soft_tissue_avatar_test
// ctest: --body @EXAMPLES@/soft_tissue_avatar/limb.gltf --frames 30 --vtu --usd --out character_test
//
// A skinned body in motion with simulated soft tissue: Romero et al. 2020, from the body to pictures.
#include "soft_tissue_avatar/report.hpp"
#include "soft_tissue_avatar/scene.hpp"
#include "support/embedded_human.hpp"
#include "support/guarded.hpp"
#include "support/progress.hpp"
#include "support/result_folder.hpp"

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/skinning/resample.hpp>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

namespace {

using namespace softtissue;
using namespace examples;

Model make_skin(const Settings& settings, const SmplBody<Scalar>& body) {
    Skinning policy;
    if (settings.skinning == "dqs") {
        policy.policy = DualQuaternion<Scalar>();
    }
    return Model(body, policy, {.pose_correctives = settings.skinning == "smpl"});
}

Scene make_scene(const Settings& settings) {
    SmplBody<Scalar> body;
    Motion<Scalar> recorded;
    SoftLayerOptions<Scalar> options;
    if (is_character_file(settings.body)) {
        require(settings.motion.empty(), "--motion: ", settings.motion, ", but ", settings.body, " moves by its own clips (--clip)");
        CharacterScene character = read_character(settings.body, settings.character);
        body = std::move(character.body);
        recorded = std::move(character.motion);
        options.region.extremities = std::move(character.extremities);
        options.region.excluded_vertices = std::move(character.hole_centers);
    } else {
        body = read_human(settings.body);
        recorded = read_human_motion(settings.motion, body.num_joints());
    }
    Motion<Scalar> motion = resample(recorded, 1.0 / settings.time_step);
    if (settings.frames > 0 && settings.frames < motion.num_frames()) {
        motion.poses.resize(size_t(settings.frames));
    }
    require(motion.num_frames() >= 2, "motion: ", motion.num_frames(), " frames at the time step, expected at least 2");
    Model skin = make_skin(settings, body);
    SoftLayer<Scalar> layer = make_soft_layer(body, options);
    Model tissue = make_tissue_model(skin, layer);
    return {std::move(body), std::move(motion), std::move(skin), std::move(layer), std::move(tissue)};
}

int run_program(const Settings& settings) {
    watch_interrupt();
    AvatarResults results;
    const double begin = seconds();
    const ResultFolder results_alone(settings.out);
    const ThreadExecutor executor(settings.threads);
    const Scene scene = make_scene(settings);
    results.seconds_setup = seconds() - begin;
    const SoftLayerReport<Scalar>& report = scene.layer.report;
    std::fprintf(stderr, "body %d vertices, %d joints; layer %.1f to %.1f mm thick, mean %.1f mm; motion %d frames at %.4g Hz\n",
                 int(scene.body.num_vertices()), int(scene.body.num_joints()), 1e3 * report.thickness_min,
                 1e3 * report.thickness_max, 1e3 * report.thickness_mean, int(scene.motion.num_frames()),
                 double(scene.motion.frame_rate));
    if (settings.element == "tet") {
        run_avatar<Tet4>(settings, scene, executor, results);
    } else {
        run_avatar<Prism6>(settings, scene, executor, results);
    }
    const std::filesystem::path json =
        settings.json.empty() ? std::filesystem::path(settings.out) / "results.json" : std::filesystem::path(settings.json);
    write_results(json, results);
    if (const std::filesystem::path page = std::filesystem::path(settings.out) / "report.html";
        write_report(page, settings, scene, results)) {
        results.pictures.push_back(page);
    }
    print_results(results, json);
    return results.steps.not_converged == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Soft tissue on a skinned body in motion. Without arguments: the embedded body and motion, with the settings "
                 "of Romero et al. 2020.");
    app.add_option("--body", settings.body, "body in SMPL's layout (.npz), or a rigged character with its clips (.glb, .gltf)");
    app.add_option("--motion", settings.motion, "motion in AMASS's layout (.npz)");
    app.add_option("--mesh", settings.character.mesh, "skinned mesh of a character that has several");
    app.add_option("--clip", settings.character.clip, "animation of a character (default: its first)");
    app.add_option("--joints", settings.character.joints,
                   "SMPL's names for joints of a character (.json): head, hands and feet are then not simulated");
    app.add_option("--frames", settings.frames, "at most so many time steps")->check(CLI::PositiveNumber);
    app.add_option("--material", settings.material, "law of the tissue")
        ->check(CLI::IsMember({"fung", "snh", "corotated", "arap"}))->capture_default_str();
    app.add_option("--skinning", settings.skinning, "smpl (with pose correctives), lbs or dqs (without)")
        ->check(CLI::IsMember({"smpl", "lbs", "dqs"}))->capture_default_str();
    app.add_option("--frame", settings.frame, "where strain is measured")
        ->check(CLI::IsMember({"unposed", "world", "retargeted"}))->capture_default_str();
    app.add_option("--element", settings.element, "cells of the tissue")
        ->check(CLI::IsMember({"tet", "prism"}))->capture_default_str();
    app.add_option("--dt", settings.time_step, "time step [s]")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("--threads", settings.threads, "threads; the results do not depend on them")->check(CLI::PositiveNumber);
    app.add_option("--out", settings.out, "folder for results")->capture_default_str();
    app.add_option("--json", settings.json, "file for figures (default: OUT/results.json)");
    app.add_flag("--vtu", settings.vtu, "also write the mesh of every frame for ParaView");
    app.add_flag("--usd", settings.usd, "also write tissue, skin and skeleton of every frame as OpenUSD text");
    CLI11_PARSE(app, argc, argv);
    return guarded("soft_tissue_avatar", [&] { return run_program(settings); });
}
