// SPDX-License-Identifier: MIT
/// @file
/// The elastic energy of a mesh: one deformation gradient and one material point per cell.
///
/// What        EnergyTerm over Element x MaterialField.
/// Packs       as many cells at a time as a register has lanes; a cell's numbers do not depend on its neighbours in the pack
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
#include <softtissue/core/pack_columns.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/energy/concepts.hpp>
#include <softtissue/energy/node_packs.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/energy/rest_packs.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/linalg/nine_number_lanes.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/packed.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <cstddef>
#include <utility>

namespace softtissue {

template <class ElementType, MaterialField Field>
    requires Element<ElementType, typename MaterialOf<Field>::Scalar>
class ElasticEnergy {
public:
    using Scalar = typename MaterialOf<Field>::Scalar;
    using CellElement = ElementType;
    using Mesh = CellMesh<ElementType, Scalar>;
    using Rest = RestPacks<ElementType, Scalar>;
    static constexpr int num_nodes = ElementType::num_nodes;

    static_assert(RealScalar<Scalar>, "assembly and solvers need a material over float or double");

    ElasticEnergy(const Mesh& mesh, Field field)
        : field_(std::move(field)),
          assembly_(validated(mesh).cells, mesh.num_vertices()),
          nodes_(mesh.cells),
          rest_(RestOperators<ElementType, Scalar>::at(mesh, mesh.rest_positions)) {
        require_covers(field_, mesh.num_cells());
    }

    const Field& field() const { return field_; }
    Field& field() { return field_; }
    Index num_cells() const { return assembly_.num_stencils(); }
    Index num_vertices() const { return assembly_.num_vertices(); }
    const Connectivity<num_nodes>& cells() const { return assembly_.stencils(); }

    /// Gradient operators, volumes and reference gradients F0, which a strain frame may replace; the connectivity stays.
    const Rest& rest() const { return rest_; }
    Rest& mutable_rest() { return rest_; }

    /// F of one cell.
    Matrix3<Scalar> deformation_gradient(const Matrix3X<Scalar>& d, Index cell) const {
        return deformation_gradient<Scalar>(Mesh::gather(d, cells().col(cell)), rest_.gradients(cell),
                                            rest_.reference_gradient(cell));
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
        return assembly_.template sum_packed_energy<width>(executor, [&](Index pack, Scalar* slots) {
            const Lanes psi = law(pack).energy_density(packed_deformation_gradient(d, pack));
            Lanes(rest_.packed_volume(pack) * psi).store(slots);
        });
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        assembly_.template add_packed_gradient<width>(
            executor,
            [&](Index pack, Scalar* slots) {
                forces_into(pack, law(pack).first_piola(packed_deformation_gradient(d, pack)), slots);
            },
            gradient);
    }

    template <Executor E>
    Scalar add_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        return assembly_.template add_packed_energy_and_gradient<width>(
            executor,
            [&](Index pack, Scalar* energies, Scalar* slots) {
                const EnergyAndStress<Lanes> psi =
                    energy_and_first_piola(law(pack), packed_deformation_gradient(d, pack));
                Lanes(rest_.packed_volume(pack) * psi.energy).store(energies);
                forces_into(pack, psi.stress, slots);
            },
            gradient);
    }

    void add_neighbours(const PrescribedVertices& prescribed,
                        std::vector<std::vector<std::int32_t>>& neighbours) const {
        assembly_.add_neighbours(prescribed, neighbours);
    }

    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) {
        assembly_.bind(prescribed, pattern);
    }

    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>& d, PsdFilter filter, BlockMatrix<Scalar>& hessian, const E& executor) {
        assembly_.template add_packed_hessian<width>(
            executor,
            [&](Index pack, Scalar* slots) {
                const Matrix9<Lanes> H = projected_hessian(law(pack), packed_deformation_gradient(d, pack), filter);
                contract_into(H, rest_.packed_gradients(pack), rest_.packed_volume(pack), slots);
            },
            hessian);
    }

private:
    using Assembly = StencilAssembly<num_nodes, Scalar>;
    using Lanes = typename Rest::Lanes;
    static constexpr int width = Rest::width;

    static const Mesh& validated(const Mesh& mesh) {
        mesh.validate();
        return mesh;
    }

    /// F0 + sum_i d_i g_i^T, of a cell or of a pack of cells.
    template <class T, class Gradients>
    static Matrix3<T> deformation_gradient(const NodePositions<ElementType, T>& d, const Gradients& g, Matrix3<T> F) {
        for (int i = 0; i < num_nodes; ++i) {
            for (int j = 0; j < 3; ++j) {
                F.col(j) += d.col(i) * g(j, i);
            }
        }
        return F;
    }

    Matrix3<Lanes> packed_deformation_gradient(const Matrix3X<Scalar>& d, Index pack) const {
        return deformation_gradient<Lanes>(nodes_.gather(d, pack), rest_.packed_gradients(pack),
                                           rest_.packed_reference_gradient(pack));
    }

    /// The laws of a pack of cells.
    auto law(Index pack) const {
        return packed_law_at<width>(field_, pack, [this, pack](int i) { return rest_.cell(pack, i); });
    }

    /// V P g_i of every lane.
    void forces_into(Index pack, const Matrix3<Lanes>& P, Scalar* slots) const {
        const auto g = rest_.packed_gradients(pack);
        const Matrix3<Lanes> VP = P * rest_.packed_volume(pack);
        for (int i = 0; i < num_nodes; ++i) {
            Vector3<Lanes> force;
            for (int k = 0; k < 3; ++k) {
                force(k) = VP(k, 0) * g(0, i) + VP(k, 1) * g(1, i) + VP(k, 2) * g(2, i);
            }
            store_columns(force, slots + Assembly::Gradients::template column_offset<width>(i, 0));
        }
    }

    /// blocks(a, b) = V sum_kl H_(.k)(.l) g_a[k] g_b[l] of every lane.
    template <class Gradients>
    static void contract_into(const Matrix9<Lanes>& H, const Gradients& g, const Lanes& volume, Scalar* slots) {
        for (int b = 0; b < num_nodes; ++b) {
            Eigen::Matrix<Lanes, 9, 3> T;
            for (int column = 0; column < 3; ++column) {
                for (int row = 0; row < 9; ++row) {
                    T(row, column) = volume * (g(0, b) * H(row, column) + g(1, b) * H(row, column + 3) +
                                               g(2, b) * H(row, column + 6));
                }
            }
            for (int a = 0; a <= b; ++a) {
                Scalar block[9][std::size_t(width)];
                for (int column = 0; column < 3; ++column) {
                    for (int row = 0; row < 3; ++row) {
                        const Lanes entry =
                            g(0, a) * T(row, column) + g(1, a) * T(row + 3, column) + g(2, a) * T(row + 6, column);
                        entry.store(block[3 * column + row]);
                    }
                }
                lanes_to_columns(
                    block, slots + Assembly::Tiles::template block_offset<width>(Assembly::Tiles::pair_index(a, b), 0));
            }
        }
    }

    Field field_;
    Assembly assembly_;
    NodePacks<num_nodes, Rest::width> nodes_;
    Rest rest_;
};

}  // namespace softtissue
