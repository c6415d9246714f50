// SPDX-License-Identifier: MIT
/// @file
/// Pose correctives of the procedural human: linear in the entries of R_j - I, by formula.
///
/// What        gives back the thickness that linear blend skinning loses at bent joints, and swells muscles.
/// Equation    If only joint j turns, a point y = x - J_j follows ((1 - W) I + W R) y, W the weights of j and all
///             joints beyond it. Across the axis its length shrinks by sqrt(1 - 2 W (1 - W)(1 - cos a)). With
///             -sym(R - I) y = (1 - cos a) y_across, the offset
///                 d(x) = -c W (1 - W) sym(R_j - I) (x - J_j)
///             undoes the part c of the shrinkage to second order in a, for every axis. c = 1 would keep distances
///             from the axis but swell the outside of a bend (as dual quaternions do); c = 0.6 about keeps the volume.
///             Muscles add
///                 d(x) = (e . vee(R_j - I)) b(x) n(x),   e . vee = sin a for a turn by a about e.
/// Shapes      3n x 9 (joints - 1) [m], sparse; column 9 (j - 1) + 3 a + b multiplies (R_j - I)[a, b].
/// Valid       zero at rest; mirror symmetric.
/// Tests       tests/unit/model/human_pose_correctives_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_solid.hpp>

#include <Eigen/SparseCore>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

class HumanPoseCorrectives {
public:
    using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

    static constexpr double given_back = 0.6;  // c

    explicit HumanPoseCorrectives(Matrix3X<double> rest_joints)
        : joints_(std::move(rest_joints)), muscles_(muscles(joints_)) {}

    /// weights are joints x n.
    SparseMatrix operator()(const HumanMesh& mesh, const MatrixX<double>& weights) const {
        const MatrixX<double> beyond = weights_beyond(weights);
        const Matrix3X<double> normals = mesh.smoothed(vertex_normals<double>(mesh.vertices, mesh.faces), 2);
        std::vector<Eigen::Triplet<double, int>> entries;
        for (Index v = 0; v < mesh.num_vertices(); ++v) {
            const Vector3<double> x = mesh.vertices.col(v);
            for (Index j = 1; j < joints_.cols(); ++j) {
                const double overlap = beyond(j, v) * (1.0 - beyond(j, v));
                Matrix3X<double> columns = Matrix3X<double>::Zero(3, 9);
                if (overlap > least_overlap) {
                    const Vector3<double> y = x - joints_.col(j);
                    for (Index a = 0; a < 3; ++a) {
                        for (Index b = 0; b < 3; ++b) {
                            columns(a, 3 * a + b) -= 0.5 * given_back * overlap * y(b);
                            columns(b, 3 * a + b) -= 0.5 * given_back * overlap * y(a);
                        }
                    }
                }
                swell(columns, j, x, normals.col(v));
                append(entries, v, j, columns);
            }
        }
        SparseMatrix result(3 * mesh.num_vertices(), 9 * (joints_.cols() - 1));
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

private:
    static constexpr double least_overlap = 1e-3;  // W (1 - W); an offset of at most a tenth of a millimetre
    static constexpr double least_offset = 1e-5;   // metres

    /// A muscle of the left side that swells when its joint turns about `axis`.
    struct Muscle {
        Index joint;
        Vector3<double> axis;
        Vector3<double> center;
        double radius;
        double height;
    };

    static std::vector<Muscle> muscles(const Matrix3X<double>& J) {
        using namespace human_joint;
        const auto between = [&J](Index a, Index b, double t, double z) -> Vector3<double> {
            return (1.0 - t) * J.col(a) + t * J.col(b) + Vector3<double>(0.0, 0.0, z);
        };
        const Vector3<double> x = Vector3<double>::UnitX();
        const Vector3<double> across_arm = Vector3<double>(-0.743, -0.669, 0.0);  // bends the forearm forwards
        return {{elbow, across_arm, between(shoulder, elbow, 0.55, 0.045), 0.040, 0.006},
                {elbow, across_arm, between(elbow, wrist, 0.20, 0.025), 0.035, 0.003},
                {shoulder, Vector3<double>::UnitZ(), between(shoulder, elbow, 0.10, 0.0), 0.045, 0.003},
                {knee, x, between(hip, knee, 0.60, -0.06), 0.060, 0.004},
                {knee, x, between(knee, ankle, 0.28, -0.06), 0.050, 0.003},
                {hip, -x, between(hip, knee, 0.0, -0.12), 0.060, 0.004},
                {ankle, x, between(knee, ankle, 0.30, -0.06), 0.050, 0.003}};
    }

    /// W: each joint's weights with those of all joints that hang from it.
    static MatrixX<double> weights_beyond(const MatrixX<double>& weights) {
        MatrixX<double> beyond = weights;
        const std::vector<std::int32_t> parents = human_parents();
        for (Index j = beyond.rows() - 1; j > 0; --j) {
            beyond.row(parents[size_t(j)]) += beyond.row(j);
        }
        return beyond;
    }

    void swell(Matrix3X<double>& columns, Index joint, const Vector3<double>& x, const Vector3<double>& normal) const {
        for (const Muscle& m : muscles_) {
            const bool is_right = joint == m.joint + 1;
            if (joint != m.joint && !is_right) {
                continue;
            }
            const double distance2 = ((is_right ? mirrored(x) : x) - m.center).squaredNorm();
            const Vector3<double> offset = m.height * std::exp(-distance2 / (2.0 * m.radius * m.radius)) * normal;
            if (offset.norm() < least_offset) {
                continue;
            }
            // A mirror turns rotation vectors (x, y, z) into (x, -y, -z).
            const Vector3<double> axis = is_right ? Vector3<double>(m.axis(0), -m.axis(1), -m.axis(2)) : m.axis;
            for (Index c = 0; c < 3; ++c) {  // vee(M)_c = (M[b, a] - M[a, b]) / 2 with a, b after c in turn
                const Index a = (c + 1) % 3;
                const Index b = (c + 2) % 3;
                columns.col(3 * b + a) += 0.5 * axis(c) * offset;
                columns.col(3 * a + b) -= 0.5 * axis(c) * offset;
            }
        }
    }

    static void append(std::vector<Eigen::Triplet<double, int>>& entries, Index v, Index joint,
                       const Matrix3X<double>& columns) {
        for (Index d = 0; d < 3; ++d) {
            for (Index c = 0; c < 9; ++c) {
                if (columns(d, c) != 0.0) {
                    entries.emplace_back(int(3 * v + d), int(9 * (joint - 1) + c), columns(d, c));
                }
            }
        }
    }

    Matrix3X<double> joints_;
    std::vector<Muscle> muscles_;
};

}  // namespace softtissue
