// SPDX-License-Identifier: MIT
// A limb of soft tissue on three joints: a volume in SMPL's form, small enough for many simulations.
#pragma once

#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/pose.hpp>

#include <support/solid_block.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace softtissue_test {

/// 0.6 x 0.15 x 0.15 m along x, joints at 0, 0.3 and 0.6 m; the side z = 0 is prescribed.
template <class ElementType, class S = double>
struct RiggedBar {
    CellMesh<ElementType, S> mesh;
    std::vector<std::int32_t> prescribed;
    SmplBody<S> body;

    explicit RiggedBar(int n = 3) {
        const auto block = solid_block<ElementType, S>({.n = n, .plan_noise = 0.05, .noise = 0.03});
        mesh = block.mesh;
        mesh.rest_positions.row(0) *= S(0.6);
        mesh.rest_positions.template bottomRows<2>() *= S(0.15);
        prescribed = block.bottom;

        const Index num_vertices = mesh.num_vertices();
        body.template_vertices = mesh.rest_positions;
        body.tree = KinematicTree({KinematicTree::no_parent, 0, 1});
        MatrixX<S> weights(num_vertices, 3), regressor = MatrixX<S>::Zero(3, num_vertices);
        for (Index v = 0; v < num_vertices; ++v) {
            const double x = double(mesh.rest_positions(0, v)) / 0.6;
            const double first = std::clamp(1 - 2 * x, 0.02, 1.0), last = std::clamp(2 * x - 1, 0.02, 1.0);
            weights.row(v) << S(first), S(1), S(last);
            weights.row(v) /= weights.row(v).sum();
        }
        const Index per_row = n + 1;  // vertices (i, j, level): i runs along x
        for (Index row = 0; row < num_vertices / per_row; ++row) {
            regressor(0, row * per_row) = regressor(2, row * per_row + n) = S(per_row) / S(num_vertices);
            regressor(1, row * per_row) = regressor(1, row * per_row + n) = S(0.5) * S(per_row) / S(num_vertices);
        }
        body.weights = SkinningWeights<S>(weights);
        body.joint_regressor = regressor.sparseView();
        RandomGenerator random(8);
        body.shape_directions = MatrixX<S>::NullaryExpr(3 * num_vertices, 2, [&] { return S(0.002 * random.normal()); });
        MatrixX<S> correctives =
            MatrixX<S>::NullaryExpr(3 * num_vertices, 18, [&] { return S(0.001 * random.normal()); });
        body.pose_directions = correctives.sparseView();
    }

    /// Bent and twisted; `amount` = 1 is far: joints turned by about 1 rad.
    static Pose<S> pose(double amount) {
        Pose<S> result = Pose<S>::rest(3);
        result.rotation_vectors.col(0) << S(0.2 * amount), S(0.1 * amount), S(0.3 * amount);
        result.rotation_vectors.col(1) << S(0.6 * amount), S(0.3 * amount), S(0.7 * amount);
        result.rotation_vectors.col(2) << S(-0.3 * amount), S(0.5 * amount), S(-0.4 * amount);
        result.translation << S(0.1 * amount), S(-0.05 * amount), S(0.02 * amount);
        return result;
    }

    /// A swing to pose(1) and back in 40 steps.
    static Pose<S> swing(int step) { return pose(0.5 - 0.5 * std::cos(3.14159265358979 * step / 20)); }
};

}  // namespace softtissue_test
