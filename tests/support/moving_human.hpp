// SPDX-License-Identifier: MIT
// The embedded human with skin of Fung's law, some steps into a jump.
#pragma once

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/model/procedural_motion.hpp>

#include <support/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

/// What is stepped, and how.
template <RealScalar S>
struct HumanRun {
    int num_steps;
    AvatarOptions<S> options = {};
    FungOrthotropicParameters<S> tissue = {.normal_modulus = S(1e4), .tangential_modulus = S(4e4)};
    S full_thickness = S(0.025);
    /// Poses that are kept of the motion, those between them interpolated linearly: the velocity jumps.
    double key_frame_rate = 0;
};

template <RealScalar S>
struct MovingHuman {
    using Field = FungOrthotropicField<S>;

    FungOrthotropicParameters<S> tissue;
    SmplBody<S> body = procedural_human<S>();
    SoftLayer<S> layer;
    CellMesh<Tet4, S> mesh;
    Motion<S> motion;

    explicit MovingHuman(const HumanRun<S>& run)
        : tissue(run.tissue),
          layer(make_soft_layer(body, {.full_thickness = run.full_thickness})),
          mesh(split_prisms(layer.mesh)),
          motion(procedural_jump<S>(1 / double(run.options.time_step))) {
        if (run.key_frame_rate > 0) {
            const size_t stride = size_t(std::lround(1 / (double(run.options.time_step) * run.key_frame_rate)));
            for (size_t k = 0; k + stride < motion.poses.size(); k += stride) {
                const Pose<S> from = motion.poses[k], to = motion.poses[k + stride];
                for (size_t i = 1; i < stride; ++i) {
                    const S t = S(i) / S(stride);
                    motion.poses[k + i].rotation_vectors = (1 - t) * from.rotation_vectors + t * to.rotation_vectors;
                    motion.poses[k + i].translation = (1 - t) * from.translation + t * to.translation;
                }
            }
        }
    }

    Field field() const {
        const std::vector<Matrix3<S>> axes = orthotropy_bases<S>(mesh.cells, column_normals(layer));
        typename Field::Bases bases(9, Index(axes.size()));
        for (size_t c = 0; c < axes.size(); ++c) {
            bases.col(Index(c)) = vec<S>(axes[c]);
        }
        return Field(tissue, bases);
    }
};

/// Counts of a run of `num_steps` steps in the middle of the jump.
struct RunSummary {
    Index inverted_at_rest = 0;
    int not_converged = 0;
    int most_iterations = 0;
    double mean_iterations = 0;
    double largest_lag = 0;          ///< [m]
    double largest_start_error = 0;  ///< of the velocity at the start [m/s]
    double mean_quasi_newton_steps = 0;
    bool is_finite = true;
    std::string worst_status = "converged";
    std::vector<Matrix3X<double>> positions;  // after each step [m]
};

template <RealScalar S>
RunSummary run_human(const HumanRun<S>& run) {
    const AvatarOptions<S>& options = run.options;
    const int num_steps = run.num_steps;
    const MovingHuman<S> human(run);
    const SequentialExecutor executor;
    const VolumetricSmpl<S> skin(human.body);
    const VolumetricSmpl<S> tissue = make_tissue_model(skin, human.layer);
    SoftTissueAvatar<Tet4, FungOrthotropicField<S>> avatar(tissue, human.mesh, human.layer.prescribed_vertices,
                                                           human.field(), executor, options);
    RunSummary summary;
    summary.inverted_at_rest = human.mesh.count_inverted(human.mesh.rest_positions);

    const auto& poses = human.motion.poses;
    const size_t begin = poses.size() / 2 - size_t(num_steps) / 2;
    avatar.start(poses[begin - 1], poses[begin]);
    const Matrix3X<S> velocity =
        (tissue.pose(poses[begin]).positions - tissue.pose(poses[begin - 1]).positions) / options.time_step;
    summary.largest_start_error = double((avatar.velocities() - velocity).cwiseAbs().maxCoeff());
    for (int step = 1; step <= num_steps; ++step) {
        const SolveReport<S> report = avatar.step(poses[begin + size_t(step)]);
        if (!report.succeeded()) {
            ++summary.not_converged;
            summary.worst_status = to_string(report.status);
        }
        summary.most_iterations = std::max(summary.most_iterations, report.iterations);
        summary.mean_iterations += double(report.iterations) / num_steps;
        summary.mean_quasi_newton_steps += double(report.quasi_newton_steps) / num_steps;
        summary.positions.push_back(avatar.positions().template cast<double>());
        summary.is_finite = summary.is_finite && avatar.positions().allFinite() && avatar.velocities().allFinite();
        const S lag = (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff();
        summary.largest_lag = std::max(summary.largest_lag, double(lag));
    }
    WARN(num_steps << " steps: quasi-Newton steps " << summary.mean_quasi_newton_steps << " mean; Newton iterations "
                   << summary.mean_iterations << " mean, " << summary.most_iterations << " most; "
                   << summary.not_converged << " not converged (" << summary.worst_status << "); tissue up to "
                   << 1e3 * summary.largest_lag << " mm from the skinned shape");
    return summary;
}

inline void check_run(const RunSummary& summary) {
    CHECK(summary.inverted_at_rest == 0);
    CHECK(summary.not_converged == 0);
    CHECK(summary.is_finite);
    CHECK(summary.most_iterations <= 10);
    CHECK(summary.largest_lag > 1e-4);
    CHECK(summary.largest_lag < 0.1);
}

}  // namespace softtissue_test
