// SPDX-License-Identifier: MIT
/// @file
/// The simulation of soft_tissue_avatar, for any element and strain frame.
#pragma once

#include "../support/any_material.hpp"
#include "../support/progress.hpp"
#include "../support/usd_output.hpp"
#include "scene.hpp"

#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/strain_frame.hpp>
#include <softtissue/mesh/split_prisms.hpp>

#include <algorithm>
#include <concepts>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

namespace examples {

using namespace softtissue;

template <class ElementType, class Frame>
using Avatar = SoftTissueAvatar<ElementType, AnyMaterialField<Scalar>, Frame, Skinning, ThreadExecutor>;

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
inline const Pose<Scalar>& strongest_pose(const Motion<Scalar>& motion) {
    const auto strength = [](const Pose<Scalar>& pose) {
        return pose.rotation_vectors.rightCols(pose.rotation_vectors.cols() - 1).squaredNorm();
    };
    return *std::max_element(motion.poses.begin(), motion.poses.end(), [&](const Pose<Scalar>& a, const Pose<Scalar>& b) {
        return strength(a) < strength(b);
    });
}

/// How far the tissue, at rest in the pose, is from the skinned shape (Romero et al. 2020, fig. 4).
template <class ElementType, class Frame>
StaticPose static_pose(const Settings& settings, const Scene& scene, const ThreadExecutor& executor, const char* frame) {
    Assembled<ElementType, Frame> assembled(settings, scene, executor);
    Avatar<ElementType, Frame>& avatar = assembled.avatar;
    const Pose<Scalar>& pose = strongest_pose(scene.motion);
    avatar.start(pose);
    const SolveReport<Scalar> report =
        avatar.settle(pose, {.max_iterations = 60, .step_tolerance = 1e-6},
                      [](const NewtonProgress<Scalar>&) { return !is_interrupted(); });
    const double error = (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff();
    std::fprintf(stderr, "static pose, %-10s frame: %s after %d iterations, %.3g mm from the skinned body\n", frame,
                 to_string(report.status), report.iterations, 1e3 * error);
    return {error, report.status};
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
    std::optional<UsdOutput> usd;
    if (settings.usd) {
        usd.emplace(scene.body, scene.layer, scene.skin.rest_joints(), 1.0 / settings.time_step);
    }
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
        results.steps.add(output.time(), report, avatar.count_inverted(), 1e3 * (seconds() - start));
        scene.skin.pose_into(poses[k], skin, executor);
        output.add_frame(skin.positions, avatar.positions());
        if (settings.vtu) {
            output.add_vtu(avatar.positions(), avatar.skinned(), mesh.cells);
        }
        if (usd) {
            usd->add_frame(skin.positions, avatar.positions(), poses[k]);
        }
        progress.update(int(k) - 1);
    }
    results.interrupted = is_interrupted();
    output.write();
    if (usd && results.steps.count > 0) {
        usd->write(std::filesystem::path(settings.out) / "soft_tissue.usda");
    }
    output.move_into(results);
}

template <class ElementType>
void run_avatar(const Settings& settings, const Scene& scene, const ThreadExecutor& executor, AvatarResults& results) {
    results.static_unposed = static_pose<ElementType, UnposedFrame>(settings, scene, executor, "unposed");
    results.static_world = static_pose<ElementType, WorldFrame>(settings, scene, executor, "world");
    results.static_retargeted = static_pose<ElementType, RestRetargetedFrame>(settings, scene, executor, "retargeted");
    if (settings.frame == "unposed") {
        simulate<ElementType, UnposedFrame>(settings, scene, executor, results);
    } else if (settings.frame == "world") {
        simulate<ElementType, WorldFrame>(settings, scene, executor, results);
    } else {
        simulate<ElementType, RestRetargetedFrame>(settings, scene, executor, results);
    }
}

}  // namespace examples
