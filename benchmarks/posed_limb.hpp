// SPDX-License-Identifier: MIT
/// @file
/// A layered limb of the paper's size in twenty poses: what quasi-static solves are timed on.
///
/// What        a tube of skin over fat, muscle and bone with three joints, 53,248 prisms, 79,488 unknowns at full size, as a
///             LayeredBody; poses bend and twist both inner joints, more and more, in random directions.
/// Smaller     with fewer columns around, and as many rings fewer, for tests
/// Boundary    the bone and both ends by linear blend skinning
#pragma once

#include "layered_limb.hpp"

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace benchmarks {

using namespace softtissue;

template <RealScalar S>
struct PosedLimb {
    static constexpr int num_poses = 20;

    LayeredBody<S> body;
    double length;

    /// Rings of `around` columns, their sides 4 mm long at full size; the limb is 0.9 m long.
    explicit PosedLimb(Index around = 64) : length(spacing(around) * double(13 * around / 4)) {
        const Index along = 13 * around / 4 + 1;
        body.layers = {around * along, 2};
        Matrix3X<S>& X = body.mesh.rest_positions;
        X.resize(3, body.layers.num_vertices());
        MatrixX<S> weights(body.layers.num_vertices(), 3);
        for (Index c = 0; c < body.layers.num_columns; ++c) {
            const double x = spacing(around) * double(c / around);
            const double angle = 2 * std::numbers::pi * double(c % around) / double(around);
            const double first = share_beyond(x, length / 3), second = share_beyond(x, 2 * length / 3);
            for (Index level = 0; level < 3; ++level) {
                const Index v = body.layers.vertex(c, level);
                const double bulge = level == 0 ? 1 : 1 + 0.15 * std::sin(9 * x + angle);
                const double radius = bulge * std::array{0.02, 0.04, 0.05}[size_t(level)];
                X.col(v) << S(x), S(radius * std::cos(angle)), S(radius * std::sin(angle));
                weights.row(v) << S(1 - first), S(first - second), S(second);
                if (level == 0 || c < around || c >= around * (along - 1)) {
                    body.prescribed.push_back(static_cast<std::int32_t>(v));
                }
            }
        }
        body.weights = SkinningWeights<S>(weights);
        body.region.triangles = tube_triangles(around, along);
        body.mesh.cells.resize(6, 2 * body.region.triangles.cols());
        for (Index c = 0; c < body.mesh.cells.cols(); ++c) {  // all of the muscle, then all of the fat
            const Index layer = c / body.region.triangles.cols(), t = c % body.region.triangles.cols();
            for (int k = 0; k < 3; ++k) {
                const std::int32_t column = body.region.triangles(k, t);
                body.mesh.cells(k, c) = std::int32_t(body.layers.vertex(column, layer));
                body.mesh.cells(k + 3, c) = std::int32_t(body.layers.vertex(column, layer + 1));
            }
        }
        body.skin_offsets = Matrix3X<S>::Zero(3, body.layers.num_columns);
    }

    /// From 0.1 to 1.1 radians a joint.
    std::vector<AffineTransform<S>> pose(int number) const {
        RandomGenerator random(std::uint64_t(100 + number));
        const double angle = 0.1 + double(number) / (num_poses - 1);
        std::vector<AffineTransform<S>> transforms(3);
        Matrix3<double> R = Matrix3<double>::Identity();
        Vector3<double> translation = Vector3<double>::Zero();
        for (int joint = 1; joint < 3; ++joint) {
            const Vector3<double> axis(0.4 * random.normal(), random.normal(), random.normal());
            const Matrix3<double> turn = rotation_matrix_from_rotation_vector<double>(angle / axis.norm() * axis);
            const Vector3<double> centre(length * joint / 3, 0, 0);
            translation += R * (centre - turn * centre);
            R = R * turn;
            transforms[size_t(joint)].linear = R.cast<S>();
            transforms[size_t(joint)].translation = translation.template cast<S>();
        }
        return transforms;
    }

private:
    static double spacing(Index around) { return 2 * std::numbers::pi * 0.045 / double(around); }
    static double share_beyond(double x, double joint) { return 1 / (1 + std::exp((joint - x) / 0.03)); }
};

/// Poses by Gradient Skinning, from which a solve starts: all vertices. The limb must outlive this.
class PoseStarts {
public:
    explicit PoseStarts(const PosedLimb<double>& limb)
        : limb_(limb),
          poisson_(limb.body.mesh, PrescribedVertices(limb.body.mesh.num_vertices(), limb.body.prescribed)),
          gradient_skinning_(poisson_, limb.body.mesh, limb.body.weights) {}

    Matrix3X<double> operator()(int number) {
        const std::vector<AffineTransform<double>> transforms = limb_.pose(number);
        Matrix3X<double> x;
        MatrixX<double> prepared;
        skin_points_into(LinearBlend<double>(), transforms, limb_.body.weights, limb_.body.mesh.rest_positions,
                         prepared, x);
        gradient_skinning_.solve_into(bone_quaternions<double>(transforms), x);
        return x;
    }

private:
    const PosedLimb<double>& limb_;
    PoissonReconstruction<Prism6, double> poisson_;
    GradientSkinning<Prism6, double> gradient_skinning_;
};

}  // namespace benchmarks
