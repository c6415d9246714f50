// SPDX-License-Identifier: MIT
/// @file
/// Smoothing of values on the vertices of a surface by the mean of the neighbours.
///
/// What        umbrella_smoothed(): a number of rounds of  v_i <- mean over the neighbours j of v_j, all vertices at once.
/// Shapes      values d x n, one column per vertex; held: one flag per vertex, or none.
/// Valid       any mesh; held vertices and those without neighbours keep their values. The mean knows no geometry: fit for
///             weights and thicknesses, while positions slide towards dense parts of the mesh.
/// Cost        rounds x edges x d
/// Tests       tests/unit/mesh/umbrella_mean_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

/// The mean of the columns of the neighbours of `vertex`, which must have some.
template <RealScalar S, int rows>
Eigen::Matrix<S, rows, 1> umbrella_mean(const TriangleMesh& mesh, const Eigen::Matrix<S, rows, Eigen::Dynamic>& values,
                                        Index vertex) {
    Eigen::Matrix<S, rows, 1> sum = Eigen::Matrix<S, rows, 1>::Zero(values.rows());
    for (const std::int32_t w : mesh.neighbours(vertex)) {
        sum += values.col(w);
    }
    return sum / S(mesh.neighbours(vertex).size());
}

template <RealScalar S, int rows>
Eigen::Matrix<S, rows, Eigen::Dynamic> umbrella_smoothed(const TriangleMesh& mesh,
                                                         Eigen::Matrix<S, rows, Eigen::Dynamic> values, int rounds,
                                                         const std::vector<bool>& held = {}) {
    Eigen::Matrix<S, rows, Eigen::Dynamic> next(values.rows(), values.cols());
    for (int round = 0; round < rounds; ++round) {
        for (Index v = 0; v < values.cols(); ++v) {
            const bool is_held = !held.empty() && held[size_t(v)];
            if (is_held || mesh.neighbours(v).empty()) {
                next.col(v) = values.col(v);
            } else {
                next.col(v) = umbrella_mean<S, rows>(mesh, values, v);
            }
        }
        values.swap(next);
    }
    return values;
}

}  // namespace softtissue
