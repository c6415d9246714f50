// SPDX-License-Identifier: MIT
/// @file
/// How good each method is on each pose: the figures of Nolte et al. 2026, tables 1 and 3.
#pragma once

#include "../support/layered_scene.hpp"

#include <softtissue/anatomy/posed_wrap.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/metric/intersection.hpp>
#include <softtissue/metric/protrusion.hpp>
#include <softtissue/ndg/evaluation.hpp>
#include <softtissue/ndg/layered_animation.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace examples {

struct MethodFigures {
    std::string name;
    MethodEvaluation<Scalar> evaluation = {};
    int not_converged = 0, poses_with_intersection = 0, poses_with_protrusion = 0;
    long iterations = 0;
    double largest_protrusion = 0.0;  // [m]

    template <class T>
    double mean(T PoseFigures<Scalar>::*figure) const {
        return evaluation.summary(figure).mean;
    }
};

struct Figures {
    std::vector<MethodFigures> methods;
    int poses = 0;
    bool has_reference = false;  // FEM is among the methods
    std::vector<int> start_dependent_poses;
    std::vector<Index> folded_triangles, infeasible_vertices;  // of the bone wrap, per pose
    bool interrupted = false;
};

/// A pose whose equilibrium from another start lies farther away than this on average has several [m].
inline constexpr double start_tolerance = 1e-4;

inline void add_pose(MethodFigures& figures, const Scene& scene, const RestOperators<Prism6, Scalar>& operators,
                     const PrescribedVertices& prescribed, const Matrix3X<Scalar>& x, const Matrix3X<Scalar>* reference,
                     const SolveReport<Scalar>& report, const Scene::Frame& frame, double milliseconds) {
    PoseFigures<Scalar> pose = reference != nullptr
                                   ? measure_pose(scene.layered.mesh, operators, prescribed, x, *reference)
                                   : measure_pose(scene.layered.mesh, x);
    pose.milliseconds = milliseconds;
    figures.evaluation.add(pose);
    figures.not_converged += report.succeeded() ? 0 : 1;
    figures.iterations += report.iterations;
    const Intersection crossing =
        compute_intersection(frame.skin, scene.body.faces, frame.muscles, scene.muscles.triangles);
    const Protrusion<Scalar> protrusion = compute_protrusion(frame.skin, scene.body.faces, frame.muscles);
    figures.poses_with_intersection += crossing.is_present() ? 1 : 0;
    figures.poses_with_protrusion += protrusion.is_present() ? 1 : 0;
    figures.largest_protrusion = std::max(figures.largest_protrusion, protrusion.magnitude);
}

inline void print_figures(const Figures& figures) {
    std::printf("\n%d poses; errors against fem\n", figures.poses);
    std::printf("               E_pos    E_grad    E_inv     E_vol   not con-      time  poses with muscle\n");
    std::printf(
        "                  mm      1e-3    cells      1e-3   verged          ms  crossing   outside, at most\n");
    for (const MethodFigures& m : figures.methods) {
        std::printf("%-11s", m.name.c_str());
        if (figures.has_reference) {
            std::printf(" %8.3f  %8.3f", 1e3 * m.mean(&PoseFigures<Scalar>::position),
                        1e3 * m.mean(&PoseFigures<Scalar>::gradient));
        } else {
            std::printf(" %8s  %8s", "-", "-");
        }
        std::printf(" %8.2f  %8.2f   %6d  %8.0f    %6d   %6d  %6.1f mm\n", m.mean(&PoseFigures<Scalar>::inverted),
                    1e3 * m.mean(&PoseFigures<Scalar>::volume), m.not_converged,
                    m.mean(&PoseFigures<Scalar>::milliseconds), m.poses_with_intersection, m.poses_with_protrusion,
                    1e3 * m.largest_protrusion);
    }
    const auto most = [](const std::vector<Index>& counts) {
        return counts.empty() ? 0 : int(*std::max_element(counts.begin(), counts.end()));
    };
    std::printf("\nbone wrap: at most %d folded triangles and %d vertices without room for muscle in a pose\n",
                most(figures.folded_triangles), most(figures.infeasible_vertices));
    if (figures.has_reference) {
        std::printf("poses with several equilibria (another start ends more than %.1f mm away on average): %d\n",
                    1e3 * start_tolerance, int(figures.start_dependent_poses.size()));
    }
}

inline void write_figures(const std::filesystem::path& path, const Figures& figures, const Scene& scene) {
    const LayeredBodyReport<Scalar>& rest = scene.layered.report;
    nlohmann::ordered_json json = {
        {"poses", figures.poses},
        {"cells", scene.layered.mesh.num_cells()},
        {"vertices", scene.layered.mesh.num_vertices()},
        {"rest",
         {{"inverted", rest.muscle.inverted_cells + rest.fat.inverted_cells},
          {"min_scaled_jacobian_muscle", rest.muscle.smallest_scaled_jacobian},
          {"min_scaled_jacobian_fat", rest.fat.smallest_scaled_jacobian},
          {"volume_bone_m3", rest.bone_volume},
          {"volume_muscle_m3", rest.muscle.volume},
          {"volume_fat_m3", rest.fat.volume}}},
        {"embedded",
         {{"bone_vertices", scene.bones.embedding.num_points()},
          {"bone_vertices_outside", scene.bones.embedding.report().num_outside},
          {"muscle_vertices", scene.muscles.embedding.num_points()},
          {"muscle_vertices_outside", scene.muscles.embedding.report().num_outside}}},
        {"bone_wrap",
         {{"folded_triangles", figures.folded_triangles}, {"infeasible_vertices", figures.infeasible_vertices}}},
        {"start_dependent_poses", figures.start_dependent_poses},
        {"interrupted", figures.interrupted}};
    for (const MethodFigures& m : figures.methods) {
        nlohmann::ordered_json& method = json["methods"][m.name];
        method["E_pos_mm"] =
            figures.has_reference ? nlohmann::ordered_json(1e3 * m.mean(&PoseFigures<Scalar>::position)) : nullptr;
        method["E_pos_max_mm"] =
            figures.has_reference
                ? nlohmann::ordered_json(1e3 * m.evaluation.summary(&PoseFigures<Scalar>::largest_position).worst)
                : nullptr;
        method["E_grad"] =
            figures.has_reference ? nlohmann::ordered_json(m.mean(&PoseFigures<Scalar>::gradient)) : nullptr;
        method["E_inv"] = m.mean(&PoseFigures<Scalar>::inverted);
        method["E_vol"] = m.mean(&PoseFigures<Scalar>::volume);
        method["not_converged"] = m.not_converged;
        method["iterations"] = double(m.iterations) / std::max(1.0, double(m.evaluation.num_poses()));
        method["milliseconds"] = m.mean(&PoseFigures<Scalar>::milliseconds);
        method["poses_with_intersection"] = m.poses_with_intersection;
        method["poses_with_protrusion"] = m.poses_with_protrusion;
        method["protrusion_max_mm"] = 1e3 * m.largest_protrusion;
    }
    AtomicFile file(path);
    file.write(json.dump(2) + "\n");
    file.commit();
}

}  // namespace examples
