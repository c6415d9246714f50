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

namespace softtissue_test {

using namespace softtissue;

template <RealScalar S>
struct MovingHuman {
    using Field = FungOrthotropicField<S>;

    SmplBody<S> body = procedural_human<S>();
    SoftLayer<S> layer = make_soft_layer(body);
    CellMesh<Tet4, S> mesh = split_prisms(layer.mesh);
    Motion<S> motion = procedural_jump<S>(120.0);

    Field field() const {
        const std::vector<Matrix3<S>> axes = orthotropy_bases<S>(mesh.cells, column_normals(layer));
        typename Field::Bases bases(9, Index(axes.size()));
        for (size_t c = 0; c < axes.size(); ++c) {
            bases.col(Index(c)) = vec<S>(axes[c]);
        }
        return Field({.normal_modulus = S(1e4), .tangential_modulus = S(4e4)}, bases);
    }
};

/// Counts of a run of `num_steps` steps in the middle of the jump.
struct RunSummary {
    Index inverted_at_rest = 0;
    int not_converged = 0;
    int most_iterations = 0;
    double mean_iterations = 0;
    double largest_lag = 0;         ///< [m]
    double largest_start_error = 0; ///< of the velocity at the start [m/s]
    bool is_finite = true;
    std::string worst_status = "converged";
};

template <RealScalar S>
RunSummary run_human(int num_steps, const AvatarOptions<S>& options = {}) {
    const MovingHuman<S> human;
    const SequentialExecutor executor;
    const VolumetricSmpl<S> skin(human.body);
    const VolumetricSmpl<S> tissue = make_tissue_model(skin, human.layer);
    SoftTissueAvatar<Tet4, FungOrthotropicField<S>> avatar(tissue, human.mesh, human.layer.prescribed_vertices, human.field(),
                                                           executor, options);
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
        summary.is_finite = summary.is_finite && avatar.positions().allFinite() && avatar.velocities().allFinite();
        const S lag = (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff();
        summary.largest_lag = std::max(summary.largest_lag, double(lag));
    }
    WARN(num_steps << " steps: Newton iterations " << summary.mean_iterations << " mean, " << summary.most_iterations
                   << " most; " << summary.not_converged << " not converged (" << summary.worst_status
                   << "); tissue up to " << 1e3 * summary.largest_lag << " mm from the skinned shape");
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
