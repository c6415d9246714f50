// SPDX-License-Identifier: MIT
/// @file
/// Energies of the edge vectors of small stencils, at positions x = p + A d.
///
/// What        hands every stencil the vectors from its first vertex to the others, takes back energy, gradient and Hessian by
///             these vectors, and carries them to the displacements d of the vertices.
/// Equation    e_m = x_m - x_0;  dE/dx_m = dE/de_m,  dE/dx_0 = - sum_m dE/de_m;  dE/dd_m = A_m^T dE/dx_m
/// Shapes      edges, gradient by edges: 3 x (num_nodes - 1); Hessian by edges: 3 (num_nodes - 1) square
/// Packs       packed_...: as many stencils at a time as a register has lanes, their edges in packs
/// Why edges   two large positions cancel before the displacements are added, so float keeps the digits of d; a Hessian that is
///             positive semi-definite in e is so in d.
/// Tests       tests/unit/energy/placed_stencils_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_columns.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/node_packs.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <int num_nodes_, RealScalar S>
class PlacedStencils {
public:
    using Scalar = S;
    static constexpr int num_nodes = num_nodes_;
    static constexpr int num_edges = num_nodes - 1;

    static constexpr int width = natural_lanes<Scalar>;
    using Lanes = Pack<Scalar, width>;

    using Edges = Eigen::Matrix<Scalar, 3, num_edges>;
    using PackedEdges = Eigen::Matrix<Lanes, 3, num_edges>;
    using EdgeHessian = Eigen::Matrix<Scalar, 3 * num_edges, 3 * num_edges>;

    /// Stencil indices must be valid; TriangleMesh has checked them.
    PlacedStencils(Connectivity<num_nodes> stencils, Matrix3X<Scalar> rest_positions)
        : assembly_(std::move(stencils), rest_positions.cols()),
          nodes_(this->stencils()),
          rest_{std::move(rest_positions), {}} {
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int m = 0; m < num_nodes; ++m) {
                const std::int32_t v = this->stencils()(m, s);
                require(rest_.origins.col(v).allFinite(), "rest position of vertex ", v, " is not finite");
            }
        }
    }

    Index num_stencils() const { return assembly_.num_stencils(); }
    Index num_packs() const { return nodes_.num_packs(); }
    /// The stencil in a lane of a pack; the lanes beyond the last stencil repeat it.
    Index stencil(Index pack, int lane) const { return nodes_.cell(pack, lane); }
    Index num_vertices() const { return assembly_.num_vertices(); }
    const Connectivity<num_nodes>& stencils() const { return assembly_.stencils(); }

    /// Displacements are measured from the placement, x = p + A d; without one, x = rest + d. It must outlive the solve.
    void set_placement(const Placement<Scalar>& placement) { placement_ = &placement; }

    Edges rest_edges(Index s) const {
        Edges edges;
        for (int m = 0; m < num_edges; ++m) {
            edges.col(m) = rest_.origins.col(stencils()(m + 1, s)) - rest_.origins.col(stencils()(0, s));
        }
        return edges;
    }

    Edges edges(const Matrix3X<Scalar>& d, Index s) const {
        const Placement<Scalar>& at = placement();
        const std::int32_t first = stencils()(0, s);
        const Vector3<Scalar> displacement = at.displacement(first, d.col(first));
        Edges edges;
        for (int m = 0; m < num_edges; ++m) {
            const std::int32_t v = stencils()(m + 1, s);
            edges.col(m) = (at.origins.col(v) - at.origins.col(first)) + (at.displacement(v, d.col(v)) - displacement);
        }
        return edges;
    }

    PackedEdges packed_rest_edges(Index pack) const {
        return packed_matrix<width>([&](int i) { return rest_edges(stencil(pack, i)); });
    }

    PackedEdges packed_edges(const Matrix3X<Scalar>& d, Index pack) const {
        const Placement<Scalar>& at = placement();
        if (at.has_maps()) {
            return packed_matrix<width>([&](int i) { return edges(d, stencil(pack, i)); });
        }
        const PackedNodes origins = nodes_.gather(at.origins, pack), displacements = nodes_.gather(d, pack);
        PackedEdges edges;
        for (int m = 0; m < num_edges; ++m) {
            for (int k = 0; k < 3; ++k) {
                edges(k, m) = (origins(k, m + 1) - origins(k, 0)) + (displacements(k, m + 1) - displacements(k, 0));
            }
        }
        return edges;
    }

    /// Sum of `energy_of(stencil, edges)`.
    template <Executor E, class EnergyOf>
    Scalar sum_energy(const Matrix3X<Scalar>& d, const E& executor, const EnergyOf& energy_of) {
        return assembly_.sum_energy(executor, [&](Index s) { return energy_of(s, edges(d, s)); });
    }

    /// `gradient_of(stencil, edges)` returns Edges.
    template <Executor E, class GradientOf>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor,
                      const GradientOf& gradient_of) {
        assembly_.add_gradient(
            executor,
            [&](Index s) {
                const Edges by_edges = gradient_of(s, edges(d, s));
                typename Assembly::GradientSlot slot;
                slot << -by_edges.rowwise().sum(), by_edges;
                pull_back_gradient(s, slot);
                return slot;
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

    /// `hessian_of(stencil, edges)` returns EdgeHessian, on column-major vec(edges).
    template <Executor E, class HessianOf>
    void add_hessian(const Matrix3X<Scalar>& d, BlockMatrix<Scalar>& hessian, const E& executor,
                     const HessianOf& hessian_of) {
        assembly_.add_hessian(
            executor,
            [&](Index s, auto blocks) {
                blocks = blocks_by_positions<Scalar>(hessian_of(s, edges(d, s)));
                pull_back(s, blocks);
            },
            hessian);
    }

    /// Sum of `energy_of(pack, edges)`, Lanes of PackedEdges.
    template <Executor E, class EnergyOf>
    Scalar sum_packed_energy(const Matrix3X<Scalar>& d, const E& executor, const EnergyOf& energy_of) {
        return assembly_.template sum_packed_energy<width>(
            executor, [&](Index pack, Scalar* slots) { Lanes(energy_of(pack, packed_edges(d, pack))).store(slots); });
    }

    /// `gradient_of(pack, edges)` returns PackedEdges.
    template <Executor E, class GradientOf>
    void add_packed_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor,
                             const GradientOf& gradient_of) {
        assembly_.template add_packed_gradient<width>(
            executor,
            [&](Index pack, Scalar* slots) { fill_gradients(pack, gradient_of(pack, packed_edges(d, pack)), slots); },
            gradient);
    }

    /// Both: `terms_of(pack, edges, by_edges)` writes PackedEdges and returns the energies.
    template <Executor E, class TermsOf>
    Scalar add_packed_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor,
                                          const TermsOf& terms_of) {
        return assembly_.template add_packed_energy_and_gradient<width>(
            executor,
            [&](Index pack, Scalar* energies, Scalar* slots) {
                PackedEdges by_edges;
                Lanes(terms_of(pack, packed_edges(d, pack), by_edges)).store(energies);
                fill_gradients(pack, by_edges, slots);
            },
            gradient);
    }

    /// `hessian_of(pack, edges)` returns EdgeHessian of Lanes.
    template <Executor E, class HessianOf>
    void add_packed_hessian(const Matrix3X<Scalar>& d, BlockMatrix<Scalar>& hessian, const E& executor,
                            const HessianOf& hessian_of) {
        assembly_.template add_packed_hessian<width>(
            executor,
            [&](Index pack, Scalar* slots) {
                const Blocks<Lanes> blocks = blocks_by_positions<Lanes>(hessian_of(pack, packed_edges(d, pack)));
                for (int i = 0; i < width; ++i) {
                    Blocks<Scalar> own = lane(blocks, i);
                    pull_back(stencil(pack, i), own);
                    for (int pair = 0; pair < Assembly::num_block_pairs; ++pair) {
                        Eigen::Map<Matrix3<Scalar>>(slots + Assembly::Tiles::template block_offset<width>(pair, i)) =
                            own.template block<3, 3>(0, 3 * pair);
                    }
                }
            },
            hessian);
    }

private:
    using Assembly = StencilAssembly<num_nodes, Scalar>;
    using Gradients = typename Assembly::Gradients;
    using PackedNodes = Eigen::Matrix<Lanes, 3, num_nodes>;
    template <class T>
    using Blocks = Eigen::Matrix<T, 3, 3 * Assembly::num_block_pairs>;

    const Placement<Scalar>& placement() const { return placement_ != nullptr ? *placement_ : rest_; }

    void fill_gradients(Index pack, const PackedEdges& by_edges, Scalar* slots) const {
        PackedNodes by_nodes;
        for (int k = 0; k < 3; ++k) {
            Lanes sum = by_edges(k, 0);
            by_nodes(k, 1) = by_edges(k, 0);
            for (int m = 1; m < num_edges; ++m) {
                sum += by_edges(k, m);
                by_nodes(k, m + 1) = by_edges(k, m);
            }
            by_nodes(k, 0) = -sum;
        }
        for (int m = 0; m < num_nodes; ++m) {
            store_columns(Vector3<Lanes>(by_nodes.col(m)), slots + Gradients::template column_offset<width>(m, 0));
        }
        if (placement().has_maps()) {
            for (int i = 0; i < width; ++i) {
                auto gradient = Gradients::template gradient_in<width>(slots, i);
                pull_back_gradient(stencil(pack, i), gradient);
            }
        }
    }

    template <class Slot>
    void pull_back_gradient(Index s, Slot& slot) const {
        if (placement().has_maps()) {
            for (int m = 0; m < num_nodes; ++m) {
                slot.col(m) = placement().pull_back(stencils()(m, s), slot.col(m));
            }
        }
    }

    /// The blocks of a stencil, or of a pack of them, by the positions of its nodes.
    template <class T>
    static Blocks<T> blocks_by_positions(const Eigen::Matrix<T, 3 * num_edges, 3 * num_edges>& H) {
        Blocks<T> blocks;
        const auto set = [&](int a, int b, int row, int column, const T& entry) {
            blocks(row, 3 * Assembly::Tiles::pair_index(a, b) + column) = entry;
        };
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                T corner(0);
                for (int b = 0; b < num_edges; ++b) {
                    T sum(0);
                    for (int a = 0; a < num_edges; ++a) {
                        const T entry = H(3 * a + row, 3 * b + column);
                        sum += entry;
                        if (a <= b) {
                            set(a + 1, b + 1, row, column, entry);
                        }
                    }
                    set(0, b + 1, row, column, -sum);
                    corner += sum;
                }
                set(0, 0, row, column, corner);
            }
        }
        return blocks;
    }

    /// From positions to displacements.
    template <class Slot>
    void pull_back(Index s, Slot& blocks) const {
        if (!placement().has_maps()) {
            return;
        }
        for (int b = 0; b < num_nodes; ++b) {
            for (int a = 0; a <= b; ++a) {
                auto block = blocks.template middleCols<3>(3 * Assembly::Tiles::pair_index(a, b));
                const Matrix3<Scalar> by_column = block * placement().map(stencils()(b, s));
                block.noalias() = placement().map(stencils()(a, s)).transpose() * by_column;
            }
        }
    }

    Assembly assembly_;
    NodePacks<num_nodes, width> nodes_;
    Placement<Scalar> rest_;
    const Placement<Scalar>* placement_ = nullptr;
};

}  // namespace softtissue
