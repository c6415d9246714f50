// SPDX-License-Identifier: MIT
/// @file
/// Deformation gradients without the rotation that the bones give, and back.
///
/// What        residual_gradients_into(): what a network learns of posed positions; target_gradients_into(): what the Poisson
///             reconstruction wants of it.
/// Equation    F_p^res = R_p^T F_p,   T_p = R_p F_p^res
/// Shapes      residuals 9 x cells: one column a cell, 3x3 row after row (as PyTorch flattens it); rotations one per cell;
///             x 3 x vertices [m]; targets 3 x 3 cells (T_p in columns 3p to 3p + 2)
/// Valid       any positions: F_p and F_p^res of an inverted cell have a negative determinant, which is no obstacle here
/// Refuses     arrays of different sizes (InvalidInput)
/// Source      Nolte et al. 2026, eq. (12)
/// Cost        150 flop a cell. Nothing is allocated once the targets have their size. Same bits for every executor.
/// Tests       tests/unit/ndg/residual_gradients_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <span>

namespace softtissue {

namespace detail {
template <RealScalar N>
using RowMajor3 = Eigen::Matrix<N, 3, 3, Eigen::RowMajor>;
}

/// F_p^res of the positions x; `rest` are the operators of the rest shape, N is the network's scalar.
template <RealScalar N, class ElementType, RealScalar S, Executor E = SequentialExecutor>
void residual_gradients_into(const CellMesh<ElementType, S>& mesh, const RestOperators<ElementType, S>& rest,
                             std::span<const Matrix3<S>> rotations, const Matrix3X<S>& x,
                             Eigen::Ref<MatrixX<N>> residuals, const E& executor = {}) {
    const Index num_cells = mesh.num_cells();
    require(rest.volumes.size() == num_cells && Index(rotations.size()) == num_cells,
            "residual gradients: operators of ", rest.volumes.size(), " cells and ", rotations.size(),
            " rotations, expected ", num_cells);
    require(x.cols() == mesh.num_vertices(), "residual gradients: ", x.cols(), " positions, expected ",
            mesh.num_vertices());
    require(residuals.rows() == 9 && residuals.cols() == num_cells, "residual gradients: room for ", residuals.rows(),
            " x ", residuals.cols(), " numbers, expected 9 x ", num_cells);
    executor.for_each_range(num_cells, [&](Index begin, Index end) {
        for (Index c = begin; c < end; ++c) {
            const Matrix3<S> F = mesh.gather(x, mesh.cells.col(c)) * rest.cell_gradients(c).transpose();
            const Matrix3<S> residual = rotations[size_t(c)].transpose() * F;
            Eigen::Map<detail::RowMajor3<N>>(residuals.col(c).data()) = residual.template cast<N>();
        }
    });
}

/// T_p of the residuals.
template <RealScalar N, RealScalar S, Executor E = SequentialExecutor>
void target_gradients_into(ConstRef<MatrixX<N>> residuals, std::span<const Matrix3<S>> rotations, Matrix3X<S>& targets,
                           const E& executor = {}) {
    require(residuals.rows() == 9 && residuals.cols() == Index(rotations.size()), "target gradients: residuals of ",
            residuals.rows(), " x ", residuals.cols(), ", expected 9 x ", rotations.size());
    targets.resize(3, 3 * residuals.cols());
    executor.for_each_range(residuals.cols(), [&](Index begin, Index end) {
        for (Index c = begin; c < end; ++c) {
            const Matrix3<S> residual =
                Eigen::Map<const detail::RowMajor3<N>>(residuals.col(c).data()).template cast<S>();
            targets.template middleCols<3>(3 * c).noalias() = rotations[size_t(c)] * residual;
        }
    });
}

}  // namespace softtissue
