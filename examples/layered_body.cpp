// SPDX-License-Identifier: MIT
// ctest: --poses 2 --methods lbs,gradient,projective --out layered_body_test
//
// A layered anatomical body in many poses: the quasi-static reference beside the methods that avoid its cost
// (Nolte et al. 2026, tables 1 and 3, fig. 9).
#include "layered_body/figures.hpp"
#include "layered_body/report.hpp"
#include "support/embedded_human.hpp"
#include "support/guarded.hpp"
#include "support/layered_pictures.hpp"
#include "support/layered_report.hpp"
#include "support/posing_methods.hpp"
#include "support/progress.hpp"
#include "support/result_folder.hpp"

#include <softtissue/skinning/joint_transforms.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>

namespace {

using namespace examples;

struct Settings {
    SceneFiles files;
    std::string motion;
    int poses = 6;
    int seed = 0;
    std::vector<std::string> methods{"fem", "lbs", "dqs", "gradient", "projective", "corotated"};
    int threads = 1;
    std::string out = "layered_body", json;
};

/// Evenly spaced frames of the motion, not turned as a whole; with a seed random ones, their joints turned at random besides.
std::vector<Pose<Scalar>> choose_poses(const Settings& settings, const Motion<Scalar>& motion) {
    std::uint64_t state = std::uint64_t(settings.seed) * 0x9E3779B97F4A7C15u + 1u;
    const auto random = [&] {  // in [0, 1)
        state = state * 6364136223846793005u + 1442695040888963407u;
        return double(state >> 11) * 0x1p-53;
    };
    std::vector<Pose<Scalar>> poses;
    for (int k = 0; k < settings.poses; ++k) {
        const double place = settings.seed > 0 ? random() : (k + 0.5) / settings.poses;
        poses.push_back(motion.poses[size_t(place * double(motion.num_frames()))]);
        Pose<Scalar>& pose = poses.back();
        if (settings.seed > 0) {
            for (double& angle : pose.rotation_vectors.reshaped()) {
                angle += 0.12 * (random() + random() + random() + random() - 2.0) * 1.73;  // standard deviation 0.12 rad
            }
        }
        pose.rotation_vectors.col(0).setZero();
        pose.translation.setZero();
    }
    return poses;
}

void examine_boundary(const Scene& scene, const Matrix3X<Scalar>& x, std::span<const AffineTransform<Scalar>> transforms,
                      Figures& figures) {
    const PosedWrapReport<Scalar> wrap =
        examine_posed_wrap<Scalar>(scene.layered, scene.layered.layers.level_positions(x, 0), transforms);
    figures.folded_triangles.push_back(wrap.folded_triangles);
    figures.infeasible_vertices.push_back(wrap.infeasible_vertices);
}

int run_program(const Settings& settings) {
    watch_interrupt();
    const ResultFolder results_alone(settings.out);
    const std::filesystem::path folder(settings.out);
    const Scene scene = make_scene(settings.files);
    const LayeredBodyReport<Scalar>& rest = scene.layered.report;
    std::fprintf(stderr,
                 "%d prisms; bone %.1f l, muscle %.1f l, fat %.1f l; inverted at rest %d, smallest scaled Jacobian %.3f and %.3f\n"
                 "embedded: %d bone and %d muscle vertices\n",
                 int(scene.layered.mesh.num_cells()), 1e3 * rest.bone_volume, 1e3 * rest.muscle.volume, 1e3 * rest.fat.volume,
                 int(rest.muscle.inverted_cells + rest.fat.inverted_cells), rest.muscle.smallest_scaled_jacobian,
                 rest.fat.smallest_scaled_jacobian, int(scene.bones.embedding.num_points()),
                 int(scene.muscles.embedding.num_points()));
    const Motion<Scalar> motion = read_human_motion(settings.motion, scene.body.num_joints());
    const std::vector<Pose<Scalar>> poses = choose_poses(settings, motion);
    PosingMethods methods(scene.layered, {}, settings.threads);
    Animation animation(scene, settings.methods, std::max(1.0, double(poses.size()) / motion.duration()));

    Figures figures;
    figures.has_reference = settings.methods.front() == "fem";
    for (const std::string& name : settings.methods) {
        figures.methods.push_back({.name = name});
    }
    LayeredReport report_page({.program = "layered_body",
                               .title = "Layers of a posed body: bone, muscle, fat",
                               .summary = (settings.files.body.empty() ? "The embedded body" : settings.files.body) +
                                          std::string(" in poses of a motion, by several methods"),
                               .has_motion = false},
                              scene, settings.methods, figures.has_reference, Index(poses.size()));
    std::vector<Shot> worst;
    double worst_change = -1.0;
    Progress progress("posing", int(poses.size() * settings.methods.size()));
    for (const Pose<Scalar>& pose : poses) {
        const auto transforms = joint_transforms<Scalar>(scene.skin.tree(), scene.skin.rest_joints(), pose);
        Matrix3X<Scalar> x, reference;
        std::vector<Shot> shots;
        double change = 0.0;
        report_page.begin_frame(double(figures.poses + 1), "pose " + std::to_string(figures.poses + 1));
        for (size_t k = 0; k < settings.methods.size() && !is_interrupted(); ++k) {
            const AnimationMethod method = method_of(settings.methods[k]);
            const double begin = seconds();
            const SolveReport<Scalar> report = methods.pose_into(method, transforms, x);
            const double milliseconds = 1e3 * (seconds() - begin);
            if (report.status == SolveStatus::cancelled) {
                break;
            }
            if (method == AnimationMethod::fem) {
                reference = x;
                if (methods.start_dependence(transforms, x) > start_tolerance) {
                    figures.start_dependent_poses.push_back(figures.poses);
                }
            }
            Scene::Frame frame = scene.frame(pose, x);
            add_pose(figures.methods[k], scene, methods.poisson().rest(), methods.poisson().prescribed(),
                     x, figures.has_reference ? &reference : nullptr, report, frame, milliseconds);
            animation.add(k, frame);
            report_page.add(k, frame, x, figures.has_reference ? &reference : nullptr);
            shots.push_back(make_shot(settings.methods[k], scene, x, std::move(frame)));
            change = std::max(change, shots.back().mean_change);
            progress.update(int(size_t(figures.poses) * settings.methods.size() + k) + 1);
        }
        if (is_interrupted()) {
            figures.interrupted = true;
            break;
        }
        examine_boundary(scene, x, transforms, figures);
        ++figures.poses;
        if (change > worst_change) {
            worst_change = change;
            worst = std::move(shots);
        }
    }
    const std::filesystem::path json = settings.json.empty() ? folder / "results.json" : std::filesystem::path(settings.json);
    print_figures(figures);
    write_figures(json, figures, scene);
    std::printf("\nresults in\n  %s\n", json.c_str());
    if (figures.poses > 0 && !figures.interrupted) {
        animation.write(folder / "layered_body.glb");
        write_comparison(folder / "methods.png", scene, worst, "Local volume change in the pose that changes most");
        std::printf("  %s\n  %s\n", (folder / "layered_body.glb").c_str(), (folder / "methods.png").c_str());
        add_figures(report_page.page(), figures, scene);
        if (report_page.page().write(folder / "report.html")) {
            std::printf("  %s\n", (folder / "report.html").c_str());
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("A layered anatomical body in many poses, by the quasi-static reference and by the methods that avoid its cost. "
                 "Without arguments: the embedded body and motion.");
    app.add_option("--body", settings.files.body, "body in SMPL's layout (.npz)");
    app.add_option("--motion", settings.motion, "motion in AMASS's layout (.npz)");
    app.add_option("--poses", settings.poses, "number of poses")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_option("--seed", settings.seed, "above 0: random frames of the motion, their joints turned by 0.12 rad")
        ->check(CLI::NonNegativeNumber)->capture_default_str();
    app.add_option("--methods", settings.methods, "of fem, lbs, dqs, gradient, projective, corotated; fem first for errors")
        ->delimiter(',')->check(CLI::IsMember({"fem", "lbs", "dqs", "gradient", "projective", "corotated"}));
    app.add_option("--bones", settings.files.bones, "bones to embed (.obj), in place of the procedural ones");
    app.add_option("--muscles", settings.files.muscles, "muscles to embed (.obj), in place of the procedural ones");
    app.add_option("--threads", settings.threads, "threads; the results do not depend on them")->check(CLI::PositiveNumber);
    app.add_option("--out", settings.out, "folder for results")->capture_default_str();
    app.add_option("--json", settings.json, "file for figures (default: OUT/results.json)");
    CLI11_PARSE(app, argc, argv);
    return guarded("layered_body", [&] {
        std::stable_partition(settings.methods.begin(), settings.methods.end(),
                              [](const std::string& name) { return name == "fem"; });
        return run_program(settings);
    });
}
