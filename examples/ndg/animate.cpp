// SPDX-License-Identifier: MIT
#include "animate.hpp"

#include "../support/embedded_human.hpp"
#include "../support/layered_pictures.hpp"
#include "../support/layered_report.hpp"
#include "../support/posing_methods.hpp"
#include "../support/progress.hpp"
#include "../support/result_file.hpp"
#include "inputs.hpp"

#include <softtissue/ndg/network_input.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace examples {

namespace {

struct AnimateSettings {
    std::string model, motion, out = "ndg.glb", picture, weights = "full";
    SceneFiles files;
    std::vector<double> betas;
    double frame_rate = 30.0;
    int frames = 0;
    int shots = 6;
    int threads = 1;
};

/// What the frames to be animated are: `count` of the motion's, `stride` apart.
struct Frames {
    Index stride = 1, count = 0;
};

Frames choose_frames(const AnimateSettings& settings, const Motion<Scalar>& motion) {
    Frames frames;
    frames.stride = std::max<Index>(1, Index(std::lround(motion.frame_rate / settings.frame_rate)));
    frames.count = (motion.num_frames() + frames.stride - 1) / frames.stride;
    if (settings.frames > 0) {
        frames.count = std::min<Index>(frames.count, settings.frames);
    }
    return frames;
}

/// At most 200 of the frames.
MatrixX<float> inputs_of_motion(const NeuralModel<float>& model, const Scene& scene, const Motion<Scalar>& motion,
                                const Frames& frames) {
    std::vector<Pose<Scalar>> poses;
    const Index step = (frames.count + 199) / 200;
    for (Index k = 0; k < frames.count; k += std::max<Index>(1, step)) {
        poses.push_back(motion.poses[size_t(k * frames.stride)]);
    }
    return network_inputs<float, Scalar>(model, scene.skin.tree(), poses,
                                         shape_input(model, scene.layered.mesh.rest_positions));
}

void animate(const AnimateSettings& settings) {
    watch_interrupt();
    require_writable(settings.out);
    const NeuralModel<float> model = read_model(settings.model);
    const Scene scene = make_scene(
        settings.files, Eigen::Map<const VectorX<Scalar>>(settings.betas.data(), Index(settings.betas.size())));
    const Motion<Scalar> motion = read_human_motion(settings.motion, scene.body.num_joints());
    const LayeredBody<Scalar>& layered = scene.layered;
    Poisson poisson = make_poisson(layered);
    const Frames frames = choose_frames(settings, motion);
    const auto small =
        quantized(model, weight_format_of(settings.weights), inputs_of_motion(model, scene, motion, frames));
    PosingNetwork network(model, layered, scene.skin.tree(), scene.body.joint_names, poisson, settings.threads,
                          small.get());

    const Index num_shots = std::min<Index>(settings.shots, frames.count);
    Animation animation(scene, {model.name}, motion.frame_rate / double(frames.stride));
    LayeredReport report({.program = "ndg animate",
                          .title = "A body in motion by a trained network",
                          .summary = model.name + " from " + settings.model + ": skin, muscles and bones"},
                         scene, {model.name}, false, frames.count);
    std::vector<Shot> shots;
    std::vector<double> times, milliseconds, inverted, changes;
    Index most_inverted = 0;
    Matrix3X<Scalar> x;
    Progress progress("animating", int(frames.count));
    for (Index k = 0; k < frames.count && !is_interrupted(); ++k) {
        const Pose<Scalar>& pose = motion.poses[size_t(k * frames.stride)];
        const auto transforms = joint_transforms<Scalar>(scene.skin.tree(), scene.skin.rest_joints(), pose);
        const double begin = seconds();
        network.pose_into(pose, transforms, x);
        milliseconds.push_back(1e3 * (seconds() - begin));
        const ColumnChange change = column_change(scene, x);
        most_inverted = std::max(most_inverted, change.num_inverted);
        times.push_back(double(k * frames.stride) / motion.frame_rate);
        inverted.push_back(double(change.num_inverted));
        changes.push_back(100.0 * change.root_mean_square);
        Scene::Frame frame = scene.frame(pose, x);
        animation.add(0, frame);
        report.begin_frame(times.back());
        report.add(0, frame, x, nullptr);
        if (k == (Index(shots.size()) * 2 + 1) * frames.count / (2 * num_shots)) {
            char label[32];
            std::snprintf(label, sizeof label, "%.2f s", double(k * frames.stride) / motion.frame_rate);
            shots.push_back(make_shot(label, scene, x, std::move(frame)));
        }
        progress.update(int(k) + 1);
    }
    require(!milliseconds.empty(), "interrupted before the first frame");
    animation.write(settings.out);
    std::vector<double> sorted = milliseconds;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    const double median = sorted[sorted.size() / 2];
    std::printf(
        "%d frames%s, %.1f ms a frame (median: network, reconstruction), at most %d of %d cells inverted\n  %s\n",
        int(milliseconds.size()), is_interrupted() ? " until the interruption" : "", median, int(most_inverted),
        int(layered.mesh.num_cells()), settings.out.c_str());
    if (!shots.empty()) {
        const std::filesystem::path picture = settings.picture.empty()
                                                  ? std::filesystem::path(settings.out).replace_extension(".png")
                                                  : std::filesystem::path(settings.picture);
        write_comparison(picture, scene, shots, model.name + ": local volume change; bones and muscles below");
        std::printf("  %s\n", picture.c_str());
    }
    HtmlReport& page = report.page();
    page.add_figure({.name = "Frames", .value = std::to_string(milliseconds.size())});
    page.add_figure({.name = "Time a frame",
                     .value = formatted("%.1f", median),
                     .unit = "ms",
                     .note = "median: network, reconstruction"});
    page.add_figure({.name = "Inverted cells, at most",
                     .value = std::to_string(most_inverted),
                     .note = "of " + std::to_string(layered.mesh.num_cells())});
    page.add_figure({.name = "Weights",
                     .value = settings.weights,
                     .note = std::to_string(model.mlp.parameters().size()) + " numbers"});
    const auto add_chart = [&](const char* title, const char* y_title, const char* name, std::vector<double> values) {
        page.add_chart(
            {.title = title, .x_title = "time [s]", .y_title = y_title, .series = {{name, times, std::move(values)}}},
            ChartKind::over_frames);
    };
    add_chart("Time a frame", "time [ms]", "network and reconstruction", milliseconds);
    add_chart("Change of volume", "root mean square [%]", "all cells", changes);
    add_chart("Inverted cells", "count", "all cells", inverted);
    const std::filesystem::path html = std::filesystem::path(settings.out).replace_extension(".html");
    if (page.write(html)) {
        std::printf("  %s\n", html.c_str());
    }
}

}  // namespace

void add_animate(CLI::App& app) {
    const auto settings = std::make_shared<AnimateSettings>();
    CLI::App* const command =
        app.add_subcommand("animate",
                           "A body in motion by a trained model: skin, muscles and bones as .glb, "
                           "and a contact sheet beside it.");
    command->add_option("--model", settings->model, "trained model (.safetensors)")->required();
    command->add_option("--body", settings->files.body, "body in SMPL's layout (.npz); default: the embedded one");
    command->add_option("--motion", settings->motion, "motion in AMASS's layout (.npz); default: the embedded one");
    command->add_option("--betas", settings->betas, "shape coefficients of the body, as 1.2,-0.5")->delimiter(',');
    command->add_option("--bones", settings->files.bones, "bones to embed (.obj), in place of the procedural ones");
    command->add_option("--muscles", settings->files.muscles,
                        "muscles to embed (.obj), in place of the procedural ones");
    command->add_option("--frame-rate", settings->frame_rate, "frames a second, about")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--frames", settings->frames, "at most so many; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->add_option("--shots", settings->shots, "frames on the contact sheet")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--threads", settings->threads, "threads; the result does not depend on them")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        ->add_option("--weights", settings->weights,
                     "of the network: full, or rounded to bfloat16, int8 or int4, which is faster for large networks")
        ->check(CLI::IsMember(weight_format_names()))
        ->capture_default_str();
    command->add_option("--out", settings->out, "the animation")->capture_default_str();
    command->add_option("--picture", settings->picture, "the contact sheet (default: as the animation, .png)");
    command->callback([settings] { animate(*settings); });
}

}  // namespace examples
