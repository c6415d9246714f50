// SPDX-License-Identifier: MIT
/// @file
/// How far deformation gradients are from what they should be.
///
/// What        mean squared error over all entries of all cells' F.
/// Equation    E_grad = 1/(9 N_p) |G X - G X^|^2 = 1/(9 N_p) sum_p |F_p - F^_p|^2
/// Shapes      x, reference 3 x vertices [m]; E_grad dimensionless.
/// Valid       no cells give 0; each cell counts once, whatever its volume.
/// Refuses     operators of another number of cells, arrays of different sizes (InvalidInput)
/// Source      Nolte et al. 2026, eq. (19)
/// Tests       tests/unit/metric/gradient_error_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

namespace softtissue {

template <class ElementType, RealScalar S>
S gradient_error(const CellMesh<ElementType, S>& mesh, const RestOperators<ElementType, S>& operators,
                 const Matrix3X<S>& x, const Matrix3X<S>& reference) {
    require(operators.volumes.size() == mesh.num_cells(), "gradient error: operators of ", operators.volumes.size(),
            " cells, expected ", mesh.num_cells());
    require(x.cols() == mesh.num_vertices() && reference.cols() == x.cols(), "gradient error: ", x.cols(),
            " positions and ", reference.cols(), " reference positions, expected ", mesh.num_vertices());
    double sum = 0;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<ElementType, S> difference =
            mesh.gather(x, mesh.cells.col(c)) - mesh.gather(reference, mesh.cells.col(c));
        const Matrix3<S> F = difference * operators.cell_gradients(c).transpose();
        sum += static_cast<double>(F.squaredNorm());
    }
    return mesh.num_cells() > 0 ? static_cast<S>(sum / (9 * static_cast<double>(mesh.num_cells()))) : S(0);
}

}  // namespace softtissue
