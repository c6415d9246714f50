// SPDX-License-Identifier: MIT
/// @file
/// Finds sparse rows that give a body's joints as weighted means of vertices, for all its shapes.
///
/// What        per joint the nearest vertices in all eight octants; their weights are the smallest ones (weighted by
///             nearness) that sum to one, give the joint in the rest shape exactly and, as well as they can, its
///             displacement along each shape direction.
/// Equation    r = O M^T (M O M^T + E)^-1 t: O the nearness; rows of M are 1, x, y, z (E = 0) and the shapes' x, y, z
///             (E = tolerance^2 times the sum of O).
/// Shapes      vertices 3 x n; joints 3 x m; directions 3n x shapes; joint_displacements 3 x m per shape;
///             result m x n.
/// Valid       joints with vertices on all sides. Weights may be negative.
/// Tests       tests/unit/model/joint_regressor_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace softtissue {

class JointRegressor {
public:
    using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

    Index support = 48;       // vertices per joint
    double tolerance = 5e-4;  // metres per standard deviation, traded against the size of the weights

    SparseMatrix operator()(const Matrix3X<double>& vertices, const Matrix3X<double>& joints,
                            const MatrixX<double>& directions,
                            const std::vector<Matrix3X<double>>& joint_displacements) const {
        std::vector<Eigen::Triplet<double, int>> entries;
        for (Index j = 0; j < joints.cols(); ++j) {
            const std::vector<std::pair<double, Index>> near = nearest(vertices, joints.col(j));
            const Index count = Index(near.size());
            const Index rows = 4 + 3 * directions.cols();
            MatrixX<double> M(rows, count);
            VectorX<double> t(rows);
            VectorX<double> nearness(count);
            t(0) = 1.0;
            t.segment<3>(1).setZero();  // positions relative to the joint
            for (Index k = 0; k < directions.cols(); ++k) {
                t.segment<3>(4 + 3 * k) = joint_displacements[size_t(k)].col(j);
            }
            for (Index i = 0; i < count; ++i) {
                const auto [distance, v] = near[size_t(i)];
                M(0, i) = 1.0;
                M.col(i).segment<3>(1) = vertices.col(v) - joints.col(j);
                for (Index k = 0; k < directions.cols(); ++k) {
                    M.col(i).segment<3>(4 + 3 * k) = directions.col(k).segment<3>(3 * v);
                }
                nearness(i) = 1.0 / distance;
            }
            const VectorX<double> r = smallest_solution(M, t, nearness);
            for (Index i = 0; i < count; ++i) {
                entries.emplace_back(int(j), int(near[size_t(i)].second), r(i));
            }
        }
        SparseMatrix result(joints.cols(), vertices.cols());
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

private:
    /// (distance, vertex) of the nearest vertices in each of the eight octants around the joint.
    std::vector<std::pair<double, Index>> nearest(const Matrix3X<double>& vertices,
                                                  const Vector3<double>& joint) const {
        std::array<std::vector<std::pair<double, Index>>, 8> octants;
        for (Index v = 0; v < vertices.cols(); ++v) {
            const Vector3<double> d = vertices.col(v) - joint;
            if ((d.array() != 0.0).all()) {  // in the mid-plane: neither left nor right
                const size_t octant = (d(0) > 0.0 ? 1u : 0u) + (d(1) > 0.0 ? 2u : 0u) + (d(2) > 0.0 ? 4u : 0u);
                octants[octant].emplace_back(d.norm(), v);
            }
        }
        std::vector<std::pair<double, Index>> result;
        for (auto& candidates : octants) {
            const auto end = candidates.begin() + std::min(support / 8, std::ptrdiff_t(candidates.size()));
            std::partial_sort(candidates.begin(), end, candidates.end());
            result.insert(result.end(), candidates.begin(), end);
        }
        return result;
    }

    VectorX<double> smallest_solution(const MatrixX<double>& M, const VectorX<double>& t,
                                      const VectorX<double>& nearness) const {
        const MatrixX<double> OMt = nearness.asDiagonal() * M.transpose();
        MatrixX<double> A = M * OMt;
        A.diagonal().tail(A.rows() - 4).array() += tolerance * tolerance * A(0, 0);
        const Eigen::LDLT<MatrixX<double>> factor(A);
        VectorX<double> r = OMt * factor.solve(t);
        return r / r.sum();
    }
};

}  // namespace softtissue
