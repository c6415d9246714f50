// SPDX-License-Identifier: MIT
// ctest: --frames 40 --out soft_tissue_avatar_test
//
// A skinned body in motion with simulated soft tissue: Romero et al. 2020, from the body to pictures.
#include "support/any_material.hpp"
#include "support/any_skinning.hpp"
#include "support/avatar_output.hpp"
#include "support/progress.hpp"

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/model/procedural_motion.hpp>
#include <softtissue/skinning/resample.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>

namespace {

using namespace softtissue;
using namespace examples;

using Scalar = double;
using Field = AnyMaterialField<Scalar>;
using Skinning = AnySkinning<Scalar>;
using Model = VolumetricSmpl<Scalar, Skinning>;
template <class ElementType, class Frame>
using Avatar = SoftTissueAvatar<ElementType, Field, Frame, Skinning, ThreadExecutor>;

struct Settings {
    std::string body, motion;
    int frames = 0;
    std::string material = "fung", skinning = "smpl", frame = "unposed", element = "tet";
    double time_step = 1.0 / 120.0;
    int threads = int(std::max(1u, std::thread::hardware_concurrency()));
    std::string out = "soft_tissue_avatar", json;
    bool vtu = false;
};

/// Everything that does not depend on element and strain frame.
struct Scene {
    SmplBody<Scalar> body;
    Motion<Scalar> motion;
    Model skin;
    SoftLayer<Scalar> layer;
    Model tissue;
};

Model make_skin(const Settings& settings, const SmplBody<Scalar>& body) {
    Skinning policy;
    if (settings.skinning == "dqs") {
        policy.policy = DualQuaternion<Scalar>();
    }
    return Model(body, policy, {.pose_correctives = settings.skinning == "smpl"});
}

Scene make_scene(const Settings& settings) {
    SmplBody<Scalar> body =
        settings.body.empty() ? procedural_human<Scalar>() : read_smpl_body<Scalar>(settings.body);
    const Motion<Scalar> recorded = settings.motion.empty()
                                        ? procedural_motion<Scalar>()
                                        : read_amass_motion<Scalar>(settings.motion, body.num_joints());
    Motion<Scalar> motion = resample(recorded, 1.0 / settings.time_step);
    if (settings.frames > 0 && settings.frames < motion.num_frames()) {
        motion.poses.resize(size_t(settings.frames));
    }
    require(motion.num_frames() >= 2, "motion: ", motion.num_frames(), " frames at the time step, expected at least 2");
    Model skin = make_skin(settings, body);
    SoftLayer<Scalar> layer = make_soft_layer(body);
    Model tissue = make_tissue_model(skin, layer);
    return {std::move(body), std::move(motion), std::move(skin), std::move(layer), std::move(tissue)};
}

template <class ElementType>
CellMesh<ElementType, Scalar> make_mesh(const SoftLayer<Scalar>& layer) {
    if constexpr (std::same_as<ElementType, Tet4>) {
        return split_prisms(layer.mesh);
    } else {
        return layer.mesh;
    }
}

template <class ElementType, class Frame>
struct Assembled {
    CellMesh<ElementType, Scalar> mesh;
    Avatar<ElementType, Frame> avatar;

    Assembled(const Settings& settings, const Scene& scene, const ThreadExecutor& executor)
        : mesh(make_mesh<ElementType>(scene.layer)),
          avatar(scene.tissue, mesh, scene.layer.prescribed_vertices,
                 make_material_field<Scalar>(settings.material,
                                             orthotropy_bases<Scalar>(mesh.cells, column_normals(scene.layer))),
                 executor, {.time_step = settings.time_step}) {}
};

/// The pose farthest from rest, turns of the whole body aside.
const Pose<Scalar>& strongest_pose(const Motion<Scalar>& motion) {
    const auto strength = [](const Pose<Scalar>& pose) {
        return pose.rotation_vectors.rightCols(pose.rotation_vectors.cols() - 1).squaredNorm();
    };
    return *std::max_element(motion.poses.begin(), motion.poses.end(), [&](const Pose<Scalar>& a, const Pose<Scalar>& b) {
        return strength(a) < strength(b);
    });
}

/// How far the tissue, at rest in the pose, is from the skinned shape (Romero et al. 2020, fig. 4) [m].
template <class ElementType, class Frame>
double static_pose_error(const Settings& settings, const Scene& scene, const ThreadExecutor& executor, const char* frame) {
    Assembled<ElementType, Frame> assembled(settings, scene, executor);
    Avatar<ElementType, Frame>& avatar = assembled.avatar;
    const Pose<Scalar>& pose = strongest_pose(scene.motion);
    avatar.start(pose);
    const SolveReport<Scalar> report =
        avatar.settle(pose, {}, [](const NewtonProgress<Scalar>&) { return !is_interrupted(); });
    const double error = (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff();
    std::fprintf(stderr, "static pose, %-10s frame: %s after %d iterations, %.3g mm from the skinned body\n", frame,
                 to_string(report.status), report.iterations, 1e3 * error);
    return error;
}

template <class ElementType, class Frame>
void simulate(const Settings& settings, const Scene& scene, const ThreadExecutor& executor, AvatarResults& results) {
    const double begin = seconds();
    Assembled<ElementType, Frame> assembled(settings, scene, executor);
    Avatar<ElementType, Frame>& avatar = assembled.avatar;
    const CellMesh<ElementType, Scalar>& mesh = assembled.mesh;
    results.vertices = mesh.num_vertices();
    results.cells = mesh.num_cells();
    results.free_vertices = avatar.prescribed().num_free();
    results.inverted_at_rest = mesh.count_inverted(mesh.rest_positions);
    results.seconds_setup += seconds() - begin;

    AvatarOutput output(settings.out, scene.body, scene.layer, 1.0 / settings.time_step, settings.vtu);
    const std::vector<Pose<Scalar>>& poses = scene.motion.poses;
    avatar.start(poses[0], poses[1]);
    PosedBody<Scalar> skin;
    Progress progress("simulating", int(poses.size()) - 2);
    for (size_t k = 2; k < poses.size() && !is_interrupted(); ++k) {
        const double start = seconds();
        const SolveReport<Scalar> report =
            avatar.step(poses[k], [](const NewtonProgress<Scalar>&) { return !is_interrupted(); });
        if (report.status == SolveStatus::cancelled) {
            break;
        }
        results.steps.add(report, avatar.count_inverted(), 1e3 * (seconds() - start));
        scene.skin.pose_into(poses[k], skin, executor);
        output.add_frame(skin.positions, avatar.positions());
        if (settings.vtu) {
            output.add_vtu(avatar.positions(), avatar.skinned(), mesh.cells);
        }
        progress.update(int(k) - 1);
    }
    results.interrupted = is_interrupted();
    output.write();
    results.pictures = output.files();
    results.largest_displacement = output.largest_displacement();
}

template <class ElementType>
void run(const Settings& settings, const Scene& scene, const ThreadExecutor& executor, AvatarResults& results) {
    results.static_unposed = static_pose_error<ElementType, UnposedFrame>(settings, scene, executor, "unposed");
    results.static_world = static_pose_error<ElementType, WorldFrame>(settings, scene, executor, "world");
    results.static_retargeted = static_pose_error<ElementType, RestRetargetedFrame>(settings, scene, executor, "retargeted");
    if (settings.frame == "unposed") {
        simulate<ElementType, UnposedFrame>(settings, scene, executor, results);
    } else if (settings.frame == "world") {
        simulate<ElementType, WorldFrame>(settings, scene, executor, results);
    } else {
        simulate<ElementType, RestRetargetedFrame>(settings, scene, executor, results);
    }
}

int run_program(const Settings& settings) {
    watch_interrupt();
    AvatarResults results;
    const double begin = seconds();
    std::filesystem::create_directories(settings.out);
    const ThreadExecutor executor(settings.threads);
    const Scene scene = make_scene(settings);
    results.seconds_setup = seconds() - begin;
    const SoftLayerReport<Scalar>& report = scene.layer.report;
    std::fprintf(stderr, "body %d vertices, %d joints; layer %.1f to %.1f mm thick, mean %.1f mm; motion %d frames at %.4g Hz\n",
                 int(scene.body.num_vertices()), int(scene.body.num_joints()), 1e3 * report.thickness_min,
                 1e3 * report.thickness_max, 1e3 * report.thickness_mean, int(scene.motion.num_frames()),
                 double(scene.motion.frame_rate));
    if (settings.element == "tet") {
        run<Tet4>(settings, scene, executor, results);
    } else {
        run<Prism6>(settings, scene, executor, results);
    }
    const std::filesystem::path json =
        settings.json.empty() ? std::filesystem::path(settings.out) / "results.json" : std::filesystem::path(settings.json);
    write_results(json, results);
    print_results(results, json);
    return results.steps.not_converged == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Soft tissue on a skinned body in motion. Without arguments: the embedded body and motion, with the settings "
                 "of Romero et al. 2020.");
    app.add_option("--body", settings.body, "body in SMPL's layout (.npz)");
    app.add_option("--motion", settings.motion, "motion in AMASS's layout (.npz)");
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
    CLI11_PARSE(app, argc, argv);
    try {
        return run_program(settings);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "soft_tissue_avatar: %s\n", error.what());
        return 1;
    }
}
