// SPDX-License-Identifier: MIT
/// @file
/// How well a deformed mesh keeps the volume of its cells, and how many are turned inside out.
///
/// What        relative volume change of each cell, and the two figures made of it.
/// Equation    c_p = V_p / V^_p - 1, V_p deformed, V^_p at rest, both exact;  E_vol = mean of c_p^2;
///             E_inv = number of cells with V_p < 0, i.e. c_p < -1
/// Shapes      x 3 x vertices [m]; c_p per cell, dimensionless.
/// Valid       no cells give 0. E_inv counts cells of negative volume, as the paper does: a cell may fold in a corner and
///             keep a positive volume (CellMesh::count_inverted finds those).
/// Refuses     positions of another number of vertices, a rest volume that is not positive (InvalidInput names the cell)
/// Source      Nolte et al. 2026, sec. 5.1 and eq. (20)
/// Departs     eq. (20) is a sum, but its table has the size of a mean: both are given.
/// Tests       tests/unit/metric/volume_change_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

namespace softtissue {

template <RealScalar S>
struct VolumeChange {
    VectorX<S> relative;     ///< c_p
    Index num_inverted = 0;  ///< E_inv
    S mean_square = S(0);    ///< E_vol
    S sum_of_squares = S(0);
};

template <class ElementType, RealScalar S>
VolumeChange<S> volume_change(const CellMesh<ElementType, S>& mesh, const Matrix3X<S>& x) {
    require(x.cols() == mesh.num_vertices(), "volume change: ", x.cols(), " positions, expected ", mesh.num_vertices());
    VolumeChange<S> change;
    change.relative.resize(mesh.num_cells());
    double sum = 0;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const S rest = ElementType::rest_volume(mesh.rest_nodes(c));
        require(rest > S(0), "volume change: cell ", c, " has a rest volume of ", rest, " m^3, expected > 0");
        const S current = ElementType::rest_volume(mesh.gather(x, mesh.cells.col(c)));
        change.num_inverted += current < S(0) ? 1 : 0;
        change.relative(c) = current / rest - S(1);
        sum += static_cast<double>(change.relative(c)) * static_cast<double>(change.relative(c));
    }
    change.sum_of_squares = static_cast<S>(sum);
    if (mesh.num_cells() > 0) {
        change.mean_square = static_cast<S>(sum / static_cast<double>(mesh.num_cells()));
    }
    return change;
}

}  // namespace softtissue
