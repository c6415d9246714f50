// SPDX-License-Identifier: MIT
/// @file
/// Energies of the edge vectors of small stencils, at positions x = p + A d.
///
/// What        hands every stencil the vectors from its first vertex to the others, takes back energy, gradient and Hessian by
///             these vectors, and carries them to the displacements d of the vertices.
/// Equation    e_m = x_m - x_0;  dE/dx_m = dE/de_m,  dE/dx_0 = - sum_m dE/de_m;  dE/dd_m = A_m^T dE/dx_m
/// Shapes      edges, gradient by edges: 3 x (num_nodes - 1); Hessian by edges: 3 (num_nodes - 1) square
/// Why edges   two large positions cancel before the displacements are added, so float keeps the digits of d; a Hessian that is
///             positive semi-definite in e is so in d.
/// Tests       tests/unit/energy/placed_stencils_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

template <int num_nodes_, RealScalar S>
class PlacedStencils {
public:
    using Scalar = S;
    static constexpr int num_nodes = num_nodes_;
    static constexpr int num_edges = num_nodes - 1;

    using Edges = Eigen::Matrix<Scalar, 3, num_edges>;
    using EdgeHessian = Eigen::Matrix<Scalar, 3 * num_edges, 3 * num_edges>;

    /// Stencil indices must be valid; TriangleMesh has checked them.
    PlacedStencils(Connectivity<num_nodes> stencils, Matrix3X<Scalar> rest_positions)
        : assembly_(std::move(stencils), rest_positions.cols()), rest_{std::move(rest_positions), {}} {
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int m = 0; m < num_nodes; ++m) {
                const std::int32_t v = this->stencils()(m, s);
                require(rest_.origins.col(v).allFinite(), "rest position of vertex ", v, " is not finite");
            }
        }
    }

    Index num_stencils() const { return assembly_.num_stencils(); }
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
                for (int m = 0; m < num_nodes; ++m) {
                    slot.col(m) = placement().pull_back(stencils()(m, s), slot.col(m));
                }
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
            executor, [&](Index s, auto blocks) { fill_blocks(s, hessian_of(s, edges(d, s)), blocks); }, hessian);
    }

    /// As add_hessian() for functions that work on several stencils at once: `fill(first, hessians)` fills the EdgeHessians of
    /// the stencils first, first + 1, ...
    template <int batch, Executor E, class Fill>
    void add_hessian_in_batches(BlockMatrix<Scalar>& hessian, const E& executor, const Fill& fill) {
        assembly_.add_hessian_by_ranges(
            executor,
            [&](Index begin, Index end, const auto& blocks_of) {
                std::array<EdgeHessian, size_t(batch)> hessians;
                for (Index first = begin; first < end; first += batch) {
                    const size_t count = size_t(std::min(Index(batch), end - first));
                    fill(first, std::span(hessians).first(count));
                    for (size_t k = 0; k < count; ++k) {
                        auto blocks = blocks_of(first + Index(k));
                        fill_blocks(first + Index(k), hessians[k], blocks);
                    }
                }
            },
            hessian);
    }

private:
    using Assembly = StencilAssembly<num_nodes, Scalar>;

    const Placement<Scalar>& placement() const { return placement_ != nullptr ? *placement_ : rest_; }

    template <class Blocks>
    void fill_blocks(Index s, const EdgeHessian& H, Blocks& blocks) const {
        Eigen::Matrix<Scalar, 3, 3 * num_edges> first_row = -H.template topRows<3>();
        for (int a = 1; a < num_edges; ++a) {
            first_row -= H.template middleRows<3>(3 * a);
        }
        Matrix3<Scalar> corner = -first_row.template leftCols<3>();
        for (int b = 1; b < num_edges; ++b) {
            corner -= first_row.template middleCols<3>(3 * b);
        }
        set_block(s, 0, 0, corner, blocks);
        for (int b = 0; b < num_edges; ++b) {
            set_block(s, 0, b + 1, first_row.template middleCols<3>(3 * b), blocks);
            for (int a = 0; a <= b; ++a) {
                set_block(s, a + 1, b + 1, H.template block<3, 3>(3 * a, 3 * b), blocks);
            }
        }
    }

    template <class Blocks>
    void set_block(Index s, int a, int b, const Matrix3<Scalar>& by_positions, Blocks& blocks) const {
        auto block = blocks.template middleCols<3>(3 * Assembly::pair_index(a, b));
        if (placement().has_maps()) {
            const Matrix3<Scalar> by_column = by_positions * placement().map(stencils()(b, s));
            block.noalias() = placement().map(stencils()(a, s)).transpose() * by_column;
        } else {
            block = by_positions;
        }
    }

    Assembly assembly_;
    Placement<Scalar> rest_;
    const Placement<Scalar>* placement_ = nullptr;
};

}  // namespace softtissue
