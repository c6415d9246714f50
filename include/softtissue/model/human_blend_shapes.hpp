// SPDX-License-Identifier: MIT
/// @file
/// Shape directions of the procedural human: ten ways in which bodies differ.
///
/// What        size, mass, leg length, shoulder width, belly, hips, chest, arm length, muscle, head and neck.
/// Equation    d(x) = sum_j w_j (m_j + k_j (x - J_j) + l_j a_j a_j^T (x - J_j)) + (sum_j w_j h_j + bumps) n(x)
///             with m the joints' own displacement (accumulated down the tree so that bones stay joined), k a growth
///             in all directions, l a growth along the bone a, h a thickness, n the skin's smoothed normal.
/// Shapes      displacement() 3n x 10 [m per standard deviation], row 3v + d; joint_displacement() 3 x 24 each.
///             Mirror symmetric. Size and legs keep the floor.
/// Valid       +-2 along one direction, +-1 along all at once: no triangle turns over, the skin does not cross itself.
/// Tests       tests/unit/model/human_blend_shapes_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_solid.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace softtissue {

class HumanBlendShapes {
public:
    static constexpr Index num_shapes = 10;
    enum Shape : Index { size, mass, leg_length, shoulder_width, belly, hips, chest, arm_length, muscle, head_size };

    explicit HumanBlendShapes(Matrix3X<double> rest_joints) : joints_(std::move(rest_joints)) {}

    /// How each joint moves, 3 x 24.
    Matrix3X<double> joint_displacement(Index shape) const {
        const Growth g = growth(shape);
        const std::vector<std::int32_t> parents = human_parents();
        Matrix3X<double> m(3, joints_.cols());
        m.col(0) = g.root + g.own.col(0);
        for (Index j = 1; j < joints_.cols(); ++j) {  // SMPL numbers parents before children
            const Index p = parents[size_t(j)];
            m.col(j) = m.col(p) + stretch(g, p, joints_.col(j)) + g.own.col(j);
        }
        return m;
    }

    /// All directions, 3n x 10; weights are joints x n.
    MatrixX<double> displacement(const HumanMesh& mesh, const MatrixX<double>& weights) const {
        const Matrix3X<double> normals = mesh.smoothed(vertex_normals<double>(mesh.vertices, mesh.faces), 8);
        MatrixX<double> result(3 * mesh.num_vertices(), num_shapes);
        for (Index k = 0; k < num_shapes; ++k) {
            const Growth g = growth(k);
            const Matrix3X<double> m = joint_displacement(k);
            for (Index v = 0; v < mesh.num_vertices(); ++v) {
                const Vector3<double> x = mesh.vertices.col(v);
                Vector3<double> d = Vector3<double>::Zero();
                double thickness = 0.0;
                for (Index j = 0; j < joints_.cols(); ++j) {
                    if (weights(j, v) > 0.0) {
                        d += weights(j, v) * (m.col(j) + stretch(g, j, x));
                        thickness += weights(j, v) * g.thickness(j);
                    }
                }
                for (const Bump& b : g.bumps) {
                    thickness += b.height * (b.at(x) + b.at(mirrored(x)));
                }
                result.col(k).segment<3>(3 * v) = d + thickness * normals.col(v);
            }
        }
        return result;
    }

private:
    /// A swelling around a point of the left half, and its mirror image.
    struct Bump {
        Vector3<double> center;
        double radius;
        double height;
        double at(const Vector3<double>& x) const {
            return std::exp(-(x - center).squaredNorm() / (2.0 * radius * radius));
        }
    };

    struct Growth {
        Vector3<double> root = Vector3<double>::Zero();
        Matrix3X<double> own = Matrix3X<double>::Zero(3, human_joint::count);
        VectorX<double> all = VectorX<double>::Zero(human_joint::count);
        VectorX<double> along = VectorX<double>::Zero(human_joint::count);
        VectorX<double> thickness = VectorX<double>::Zero(human_joint::count);
        std::vector<Bump> bumps;
    };

    /// (k_j + l_j a_j a_j^T)(x - J_j)
    Vector3<double> stretch(const Growth& g, Index j, const Vector3<double>& x) const {
        Vector3<double> d = x - joints_.col(j);
        Vector3<double> result = g.all(j) * d;
        if (g.along(j) != 0.0) {
            const Vector3<double> a = bone(j);
            result += g.along(j) * a.dot(d) * a;
        }
        return result;
    }

    /// Direction from joint j to the next one of its chain.
    Vector3<double> bone(Index j) const {
        constexpr std::array<int, human_joint::count> next{3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 10, 11,
                                                           15, 16, 17, 15, 18, 19, 20, 21, 22, 23, 22, 23};
        return (joints_.col(next[size_t(j)]) - joints_.col(j)).normalized();
    }

    static void set_both(VectorX<double>& values, std::initializer_list<std::pair<Index, double>> entries) {
        for (const auto& [joint, value] : entries) {
            values(joint) = value;
            values(mirror_joint(joint)) = value;
        }
    }
    static void move_both(Growth& g, Index joint, const Vector3<double>& d) {
        g.own.col(joint) = d;
        g.own.col(mirror_joint(joint)) = mirrored(d);
    }

    /// The ten designs; lengths in metres per standard deviation.
    Growth growth(Index shape) const {
        using namespace human_joint;
        Growth g;
        switch (shape) {
            case size:
                g.all.setConstant(0.035);
                g.root = 0.035 * joints_.col(pelvis);
                break;
            case mass:
                set_both(g.thickness, {{pelvis, .009},
                                       {spine1, .010},
                                       {spine2, .009},
                                       {spine3, .007},
                                       {collar, .005},
                                       {neck, .003},
                                       {head, .001},
                                       {hip, .007},
                                       {knee, .004},
                                       {ankle, .001},
                                       {shoulder, .005},
                                       {elbow, .0035},
                                       {wrist, .0005}});
                g.bumps = {{{0.0, 1.03, 0.10}, 0.09, 0.004}};
                break;
            case leg_length:
                set_both(g.along, {{hip, 0.03}, {knee, 0.03}});
                g.root(1) = 0.03 * (joints_(1, hip) - joints_(1, ankle));
                set_both(g.along, {{spine1, -0.02}, {spine2, -0.02}});
                break;
            case shoulder_width:
                move_both(g, collar, {0.003, 0.0, 0.0});
                move_both(g, shoulder, {0.009, 0.0, 0.0});
                g.bumps = {{{0.15, 1.30, -0.03}, 0.06, 0.004}};
                break;
            case belly:
                g.bumps = {{{0.0, 1.06, 0.11}, 0.075, 0.007}, {{0.09, 1.05, 0.04}, 0.07, 0.006}};
                break;
            case hips:
                move_both(g, hip, {0.003, 0.0, 0.0});
                move_both(g, knee, {-0.002, 0.0, 0.0});
                g.bumps = {{{0.15, 0.90, -0.01}, 0.08, 0.007}, {{0.08, 0.89, -0.12}, 0.06, 0.006}};
                break;
            case chest:
                g.bumps = {{{0.075, 1.28, 0.09}, 0.05, 0.009}, {{0.09, 1.30, -0.10}, 0.08, 0.003}};
                break;
            case arm_length:
                set_both(g.along, {{shoulder, 0.035}, {elbow, 0.035}, {wrist, 0.03}});
                break;
            case muscle:
                g = muscle_growth();
                break;
            default:
                set_both(g.all, {{head, 0.035}});
                set_both(g.along, {{neck, 0.06}});
                set_both(g.thickness, {{neck, 0.003}});
        }
        return g;
    }

    Growth muscle_growth() const {
        using namespace human_joint;
        const auto between = [this](Index a, Index b, double t, double z) -> Vector3<double> {
            return (1.0 - t) * joints_.col(a) + t * joints_.col(b) + Vector3<double>(0.0, 0.0, z);
        };
        Growth g;
        set_both(g.thickness, {{neck, 0.002}, {collar, 0.002}, {spine3, 0.002}, {spine1, -0.002}});
        g.bumps = {{between(shoulder, elbow, 0.15, 0.0), 0.05, 0.005},
                   {between(shoulder, elbow, 0.55, 0.01), 0.05, 0.005},
                   {between(elbow, wrist, 0.25, 0.0), 0.045, 0.004},
                   {between(hip, knee, 0.45, 0.05), 0.09, 0.006},
                   {between(hip, knee, 0.50, -0.05), 0.08, 0.004},
                   {between(knee, ankle, 0.28, -0.04), 0.06, 0.006},
                   {{0.08, 1.31, 0.07}, 0.05, 0.005},
                   {{0.13, 1.28, -0.09}, 0.06, 0.005},
                   {{0.08, 0.90, -0.11}, 0.06, 0.004}};
        return g;
    }

    Matrix3X<double> joints_;
};

}  // namespace softtissue
