// SPDX-License-Identifier: MIT
/// @file
/// Skinning weights of the procedural human.
///
/// What        each joint owns what lies beyond a soft cut through it: s_j(x) rises from 0 to 1 across the cut.
/// Equation    C_j = sum of W_c over the children c of j,  W_j = C_j + (1 - C_j) s_j,  w_j = W_j - C_j;
///             so w_j >= 0 and the weights of a vertex sum to W_root = 1. Then smoothed along the skin.
/// Shapes      joints x n, at most max_joints entries per column above zero; mirror symmetric to the bit.
/// Tests       tests/unit/model/human_skinning_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_solid.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace softtissue {

class HumanSkinning {
public:
    static constexpr size_t max_joints = 6;

    explicit HumanSkinning(Matrix3X<double> rest_joints) : joints_(std::move(rest_joints)) {}

    /// joints x n.
    MatrixX<double> weights(const HumanMesh& mesh) const {
        MatrixX<double> result(human_joint::count, mesh.num_vertices());
        for (Index v = 0; v < mesh.num_vertices(); ++v) {
            result.col(v) = at(mesh.vertices.col(v));
        }
        result = mesh.smoothed(std::move(result), 6);
        for (Index v = 0; v < mesh.num_vertices(); ++v) {
            keep_largest(result.col(v));
        }
        for (Index v = 0; v < mesh.num_vertices(); ++v) {
            const Index w = mesh.mirror[size_t(v)];
            if (v <= w) {
                symmetrise(result, v, w);
            }
        }
        return result;
    }

    /// The weights at a point of the skin, before smoothing.
    VectorX<double> at(const Vector3<double>& x) const {
        using namespace human_joint;
        const Vector3<double> y = mirrored(x);
        VectorX<double> w = VectorX<double>::Zero(count);
        const double left = arm(x, w, 0);
        const double right = arm(y, w, 1);
        const double arms = left + right;
        double beyond = arms + neck_and_head(x, w, 1.0 - arms);  // C of the joint at hand
        for (const auto& [joint, low, high] :
             {Cut{spine3, 1.21, 1.35}, Cut{spine2, 1.10, 1.24}, Cut{spine1, 0.99, 1.13}}) {
            w(joint) = (1.0 - beyond) * smooth_step(low, high, x(1));
            beyond += w(joint);
        }
        beyond += leg(x, w, 0, 1.0 - arms) + leg(y, w, 1, 1.0 - arms);
        w(pelvis) = 1.0 - beyond;
        return w;
    }

private:
    struct Cut {
        Index joint;
        double low;
        double high;
    };

    /// s of a cut through joint j across `direction`, from `before` to `after` metres along it.
    double cut(const Vector3<double>& x, Index j, const Vector3<double>& direction, double before, double after) const {
        return smooth_step(before, after, direction.normalized().dot(x - joints_.col(j)));
    }

    /// Weights of hand to collar; x is mirrored for the right side (side = 1). Returns W of the collar.
    double arm(const Vector3<double>& x, VectorX<double>& w, Index side) const {
        using namespace human_joint;
        const Vector3<double> upper = joints_.col(elbow) - joints_.col(shoulder);
        const Vector3<double> lower = joints_.col(wrist) - joints_.col(elbow);
        const Vector3<double> above(-upper(1), upper(0), 0.0);
        // Nothing far below the line of the arm belongs to it: the flank, the hip, the leg.
        const double limb = cut(x, shoulder, above, -0.15, -0.07);
        const double at_collar = smooth_step(0.02, 0.14, x(0)) * smooth_step(1.27, 1.40, x(1));
        const std::array<std::pair<Index, double>, 5> cuts{
            {{hand, cut(x, hand, lower, -0.03, 0.03)},
             {wrist, cut(x, wrist, lower, -0.03, 0.03)},
             {elbow, cut(x, elbow, upper.normalized() + lower.normalized(), -0.045, 0.045)},
             {shoulder, limb * smooth_step(0.110, 0.215, x(0) - 0.15 * (x(1) - joints_(1, shoulder)))},
             {collar, at_collar}}};
        double beyond = 0.0;
        for (const auto& [joint, s] : cuts) {
            const double inside = joint == collar || joint == shoulder ? s : s * limb * smooth_step(0.2, 0.25, x(0));
            w(joint + side) = (1.0 - beyond) * inside;
            beyond += w(joint + side);
        }
        return beyond;
    }

    /// Weights of toes to hip, times `share` of the vertex. Returns W of the hip.
    double leg(const Vector3<double>& x, VectorX<double>& w, Index side, double share) const {
        using namespace human_joint;
        const Vector3<double> shin = joints_.col(ankle) - joints_.col(knee);
        const std::array<std::pair<Index, double>, 4> cuts{
            {{foot, cut(x, foot, {0.1, -0.1, 1.0}, -0.025, 0.025) * smooth_step(0.12, 0.08, x(1))},
             {ankle, cut(x, ankle, {0.0, -1.0, 0.3}, -0.03, 0.03)},
             {knee, cut(x, knee, shin, -0.05, 0.05)},
             {hip, cut(x, hip, {0.48, -0.85, 0.22}, -0.035, 0.085)}}};
        // Both legs share the skin between them above the crotch, not the inner sides of the thighs below it.
        const double seam = 0.003 + 0.02 * smooth_step(0.77, 0.83, x(1));
        const double of_side = share * smooth_step(-seam, seam, x(0));
        double beyond = 0.0;
        for (const auto& [joint, s] : cuts) {
            w(joint + side) = of_side * (1.0 - beyond) * s;
            beyond += (1.0 - beyond) * s;
        }
        return of_side * beyond;
    }

    /// Weights of head and neck, times `share` of the vertex. Returns W of the neck.
    double neck_and_head(const Vector3<double>& x, VectorX<double>& w, double share) const {
        using namespace human_joint;
        w(head) = share * cut(x, head, {0.0, 0.8, 0.6}, -0.045, 0.015);
        const double column = smooth_step(0.13, 0.07, std::abs(x(0)));
        w(neck) = (share - w(head)) * column * cut(x, neck, {0.0, 0.95, 0.3}, -0.035, 0.045);
        return w(head) + w(neck);
    }

    /// Drops weights below 0.2 % and all but the largest max_joints, and normalises.
    template <class Column>
    static void keep_largest(Column column) {
        std::vector<double> sorted(column.data(), column.data() + column.size());
        std::sort(sorted.begin(), sorted.end());
        const double least = std::max(sorted[sorted.size() - max_joints], 2e-3);
        for (Index j = 0; j < column.size(); ++j) {
            column(j) = column(j) < least ? 0.0 : column(j);
        }
        column /= column.sum();
    }

    static void symmetrise(MatrixX<double>& weights, Index v, Index w) {
        const VectorX<double> old = weights.col(v);
        for (Index j = 0; j < old.size(); ++j) {
            const Index k = mirror_joint(j);
            weights(k, w) = v == w ? 0.5 * (old(j) + old(k)) : old(j);
        }
    }

    Matrix3X<double> joints_;
};

}  // namespace softtissue
