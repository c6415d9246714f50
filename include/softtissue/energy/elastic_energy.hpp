// SPDX-License-Identifier: MIT
/// @file
/// The elastic energy of a mesh: one deformation gradient and one material point per cell.
///
/// What        EnergyTerm over Element x MaterialField.
/// Equation    E(d) = sum_c V_c psi_c(F_c),  F_c = F0_c + sum_i d_i g_i^T
///             F0 is the gradient of the shape that d is measured from: the identity for the rest shape, see strain_frame.hpp.
/// Shapes      d, gradient 3 x vertices; Hessian 3x3 blocks (a, b) = V sum_kl dP_.k/dF_.l g_a[k] g_b[l]
/// Units       d m, energy J, gradient N, Hessian N/m
/// Refuses     a mesh that CellMesh::validate() refuses, a field of another number of cells
/// Source      Romero et al. 2020, sec. 4.2; Nolte et al. 2026, eq. (3)
/// Cost        per cell and Hessian: the material, plus 81 num_nodes + 27 num_nodes (num_nodes + 1) / 2 multiply-adds
/// Tests       tests/unit/energy/elastic_energy_test.cpp, tests/laws/energy_laws_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/energy/concepts.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <type_traits>

namespace softtissue {

template <class ElementType, MaterialField Field>
    requires Element<ElementType, typename MaterialOf<Field>::Scalar>
class ElasticEnergy {
public:
    using Scalar = typename MaterialOf<Field>::Scalar;
    using CellElement = ElementType;
    using Mesh = CellMesh<ElementType, Scalar>;
    static constexpr int num_nodes = ElementType::num_nodes;

    static_assert(RealScalar<Scalar>, "assembly and solvers need a material over float or double");

    ElasticEnergy(const Mesh& mesh, Field field)
        : field_(std::move(field)),
          assembly_(validated(mesh).cells, mesh.num_vertices()),
          rest_(RestOperators<ElementType, Scalar>::at(mesh, mesh.rest_positions)) {
        require_covers(field_, mesh.num_cells());
    }

    const Field& field() const { return field_; }
    Field& field() { return field_; }
    const RestOperators<ElementType, Scalar>& rest() const { return rest_; }
    Index num_cells() const { return assembly_.num_stencils(); }
    Index num_vertices() const { return assembly_.num_vertices(); }
    const Connectivity<num_nodes>& cells() const { return assembly_.stencils(); }

    /// Replaces the rest operators (rest-retargeted strain); the connectivity stays.
    RestOperators<ElementType, Scalar>& mutable_rest() { return rest_; }

    /// F0 per cell, 3 x 3 cells; empty means the identity.
    Matrix3X<Scalar>& reference_gradients() { return reference_gradients_; }

    /// F of one cell.
    Matrix3<Scalar> deformation_gradient(const Matrix3X<Scalar>& d, Index cell) const {
        Matrix3<Scalar> F = Matrix3<Scalar>::Identity();
        if (reference_gradients_.cols() > 0) {
            F = reference_gradients_.template middleCols<3>(3 * cell);
        }
        for (int i = 0; i < num_nodes; ++i) {
            F.noalias() += d.col(cells()(i, cell)) * rest_.gradients.col(num_nodes * cell + i).transpose();
        }
        return F;
    }

    /// Cells whose deformation gradient has det F <= 0.
    Index count_inverted(const Matrix3X<Scalar>& d) const {
        Index inverted = 0;
        for (Index c = 0; c < num_cells(); ++c) {
            inverted += deformation_gradient(d, c).determinant() > Scalar(0) ? 0 : 1;
        }
        return inverted;
    }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E& executor) {
        return assembly_.sum_energy(executor, [&](Index c) {
            return rest_.volumes(c) * field_.at(c).energy_density(deformation_gradient(d, c));
        });
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        assembly_.add_gradient(
            executor,
            [&](Index c) -> NodePositions<ElementType, Scalar> {
                const Matrix3<Scalar> P = field_.at(c).first_piola(deformation_gradient(d, c));
                return rest_.volumes(c) * P * rest_.gradients.template middleCols<num_nodes>(num_nodes * c);
            },
            gradient);
    }

    void add_neighbours(const PrescribedVertices& prescribed, std::vector<std::vector<std::int32_t>>& neighbours) const {
        assembly_.add_neighbours(prescribed, neighbours);
    }

    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) { assembly_.bind(prescribed, pattern); }

    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>& d, PsdFilter filter, BlockMatrix<Scalar>& hessian, const E& executor) {
        assembly_.add_hessian(
            executor,
            [&](Index c, auto blocks) {
                const Matrix9<Scalar> H =
                    rest_.volumes(c) * projected_hessian(field_.at(c), deformation_gradient(d, c), filter);
                contract_into(H, rest_.cell_gradients(c), blocks);
            },
            hessian);
    }

private:
    static const Mesh& validated(const Mesh& mesh) {
        mesh.validate();
        return mesh;
    }

    /// blocks(a, b) = sum_kl H_(.k)(.l) g_a[k] g_b[l]
    template <class Blocks>
    static void contract_into(const Matrix9<Scalar>& H, const NodePositions<ElementType, Scalar>& g, Blocks& blocks) {
        for (int b = 0; b < num_nodes; ++b) {
            const Eigen::Matrix<Scalar, 9, 3> T =
                g(0, b) * H.template leftCols<3>() + g(1, b) * H.template middleCols<3>(3) + g(2, b) * H.template rightCols<3>();
            for (int a = 0; a <= b; ++a) {
                blocks.template middleCols<3>(3 * StencilAssembly<num_nodes, Scalar>::pair_index(a, b)) =
                    g(0, a) * T.template topRows<3>() + g(1, a) * T.template middleRows<3>(3) +
                    g(2, a) * T.template bottomRows<3>();
            }
        }
    }

    Field field_;
    StencilAssembly<num_nodes, Scalar> assembly_;
    RestOperators<ElementType, Scalar> rest_;
    Matrix3X<Scalar> reference_gradients_;
};

}  // namespace softtissue
