// SPDX-License-Identifier: MIT
/// @file
/// What elasticity keeps of the rest shape: a gradient operator and a volume per cell, and a lumped mass per vertex.
///
/// Equation    F = sum_i x_i g_i^T = I + sum_i d_i g_i^T for x = X + d;  m_i = density * sum_cells integral of N_i
/// Shapes      gradients 3 x (num_nodes * cells), columns num_nodes * cell + i [1/m]; volumes cells [m^3]; masses vertices [kg]
/// Source      Romero et al. 2020, sec. 4.2; Nolte et al. 2026, sec. 3.2
/// Tests       tests/unit/energy/rest_operators_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <cmath>

namespace softtissue {

template <class ElementType, RealScalar S>
struct RestOperators {
    using Scalar = S;
    static constexpr int num_nodes = ElementType::num_nodes;

    Matrix3X<Scalar> gradients;
    VectorX<Scalar> volumes;

    /// For the cells of `mesh` measured at `positions`, 3 x vertices. Volumes carry their sign.
    static RestOperators at(const CellMesh<ElementType, Scalar>& mesh, const Matrix3X<Scalar>& positions) {
        RestOperators result{Matrix3X<Scalar>(3, num_nodes * mesh.num_cells()), VectorX<Scalar>(mesh.num_cells())};
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            result.update_cell(mesh, positions, c);
        }
        return result;
    }

    /// Recomputes one cell in place.
    void update_cell(const CellMesh<ElementType, Scalar>& mesh, const Matrix3X<Scalar>& positions, Index cell) {
        const NodePositions<ElementType, Scalar> X = mesh.gather(positions, mesh.cells.col(cell));
        gradients.template middleCols<num_nodes>(num_nodes * cell) = ElementType::gradient_operator(X);
        volumes(cell) = ElementType::rest_volume(X);
    }

    /// g_1 ... g_n of one cell.
    NodePositions<ElementType, Scalar> cell_gradients(Index cell) const {
        return gradients.template middleCols<num_nodes>(num_nodes * cell);
    }
};

/// The mass of each vertex for one density [kg/m^3]: the integral of its shape functions. Refuses a density that is not positive.
template <class ElementType, RealScalar S>
VectorX<S> lumped_masses(const CellMesh<ElementType, S>& mesh, std::type_identity_t<S> density) {
    require(std::isfinite(density) && density > S(0), "density = ", density, " kg/m^3, expected > 0");
    VectorX<S> masses = VectorX<S>::Zero(mesh.num_vertices());
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodeValues<ElementType, S> integrals = ElementType::shape_integrals(mesh.rest_nodes(c));
        for (int i = 0; i < ElementType::num_nodes; ++i) {
            masses(mesh.cells(i, c)) += density * integrals(i);
        }
    }
    return masses;
}

}  // namespace softtissue
