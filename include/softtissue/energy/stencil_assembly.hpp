// SPDX-License-Identifier: MIT
/// @file
/// From stencils to vertices: slots per stencil, gathered in a fixed order.
///
/// What        every stencil (a cell, a hinge, ...) of num_nodes vertices writes its gradient and Hessian into slots of its own;
///             a gather then adds the slots vertex by vertex in ascending stencil order: the same bits for every executor.
/// Shapes      gradient slot 3 x num_nodes; Hessian slot: blocks (a, b), a <= b, 3x3 each, of a symmetric stencil Hessian.
/// Memory      Scalar[3 num_nodes] per stencil; Scalar[9 num_nodes (num_nodes + 1) / 2] more from the first Hessian on.
/// Tests       tests/unit/energy/stencil_assembly_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

template <int num_nodes_, RealScalar S>
class StencilAssembly {
public:
    using Scalar = S;
    static constexpr int num_nodes = num_nodes_;
    static constexpr int num_block_pairs = num_nodes * (num_nodes + 1) / 2;

    using GradientSlot = Eigen::Matrix<Scalar, 3, num_nodes>;

    StencilAssembly(Connectivity<num_nodes> stencils, Index num_vertices)
        : stencils_(std::move(stencils)),
          energy_slots_(stencils_.cols()),
          gradient_slots_(3, num_nodes * stencils_.cols()) {
        incidence_offsets_.assign(size_t(num_vertices) + 1, 0);
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int a = 0; a < num_nodes; ++a) {
                ++incidence_offsets_[size_t(stencils_(a, s)) + 1];
            }
        }
        for (size_t v = 0; v < size_t(num_vertices); ++v) {
            incidence_offsets_[v + 1] += incidence_offsets_[v];
        }
        incidences_.resize(size_t(incidence_offsets_.back()));
        std::vector<std::int32_t> next(incidence_offsets_.begin(), incidence_offsets_.end() - 1);
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int a = 0; a < num_nodes; ++a) {
                incidences_[size_t(next[size_t(stencils_(a, s))]++)] = static_cast<std::int32_t>(num_nodes * s + a);
            }
        }
    }

    Index num_stencils() const { return stencils_.cols(); }
    Index num_vertices() const { return static_cast<Index>(incidence_offsets_.size()) - 1; }
    const Connectivity<num_nodes>& stencils() const { return stencils_; }

    /// Calls `energy_of(stencil)` for each stencil; returns the sum, added in stencil order.
    template <Executor E, class EnergyOf>
    Scalar sum_energy(const E& executor, const EnergyOf& energy_of) {
        executor.for_each_range(num_stencils(), [&](Index begin, Index end) {
            for (Index s = begin; s < end; ++s) {
                energy_slots_(s) = energy_of(s);
            }
        });
        return energy_slots_.sum();
    }

    /// Calls `gradient_of(stencil) -> GradientSlot` for each stencil and adds the results to `gradient`, 3 x num_vertices.
    template <Executor E, class GradientOf>
    void add_gradient(const E& executor, const GradientOf& gradient_of, Matrix3X<Scalar>& gradient) {
        executor.for_each_range(num_stencils(), [&](Index begin, Index end) {
            for (Index s = begin; s < end; ++s) {
                gradient_slots_.template middleCols<num_nodes>(num_nodes * s) = gradient_of(s);
            }
        });
        executor.for_each_range(num_vertices(), [&](Index begin, Index end) {
            for (Index v = begin; v < end; ++v) {
                for (std::int32_t k = incidence_offsets_[size_t(v)]; k < incidence_offsets_[size_t(v) + 1]; ++k) {
                    gradient.col(v) += gradient_slots_.col(incidences_[size_t(k)]);
                }
            }
        });
    }

    /// Appends the free neighbours of every free vertex, for BlockPattern.
    void add_neighbours(const PrescribedVertices& prescribed,
                        std::vector<std::vector<std::int32_t>>& neighbours) const {
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int b = 0; b < num_nodes; ++b) {
                const std::int32_t column = prescribed.free_index(stencils_(b, s));
                for (int a = 0; a < num_nodes && column != PrescribedVertices::prescribed; ++a) {
                    const std::int32_t row = prescribed.free_index(stencils_(a, s));
                    if (row != PrescribedVertices::prescribed) {
                        neighbours[size_t(column)].push_back(row);
                    }
                }
            }
        }
    }

    /// Looks up where every block goes; once per pattern, before add_hessian().
    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) {
        ranks_.resize(num_nodes, num_nodes * num_stencils());
        for (Index s = 0; s < num_stencils(); ++s) {
            for (int b = 0; b < num_nodes; ++b) {
                const std::int32_t column = prescribed.free_index(stencils_(b, s));
                for (int a = 0; a < num_nodes; ++a) {
                    const std::int32_t row = prescribed.free_index(stencils_(a, s));
                    const bool is_free =
                        column != PrescribedVertices::prescribed && row != PrescribedVertices::prescribed;
                    ranks_(a, num_nodes * s + b) = is_free ? pattern.rank(column, row) : PrescribedVertices::prescribed;
                }
            }
        }
        free_vertices_ = prescribed.free_vertices();
        hessian_slots_.resize(3, 3 * num_block_pairs * num_stencils());
    }

    /// Calls `hessian_of(stencil, blocks)` for each stencil, which fills `blocks` (3 x 3 num_block_pairs; block (a, b), a <= b,
    /// at pair_index(a, b)) and adds the results to `hessian`. Needs bind().
    template <Executor E, class HessianOf>
    void add_hessian(const E& executor, const HessianOf& hessian_of, BlockMatrix<Scalar>& hessian) {
        add_hessian_by_ranges(
            executor,
            [&](Index begin, Index end, const auto& blocks_of) {
                for (Index s = begin; s < end; ++s) {
                    hessian_of(s, blocks_of(s));
                }
            },
            hessian);
    }

    /// As add_hessian() for functions that work on many stencils at once: `fill(begin, end, blocks_of)` fills blocks_of(stencil)
    /// of each stencil from begin to end.
    template <Executor E, class Fill>
    void add_hessian_by_ranges(const E& executor, const Fill& fill, BlockMatrix<Scalar>& hessian) {
        executor.for_each_range(num_stencils(), [&](Index begin, Index end) {
            fill(begin, end, [&](Index s) {
                return hessian_slots_.template middleCols<3 * num_block_pairs>(3 * num_block_pairs * s);
            });
        });
        executor.for_each_range(Index(free_vertices_.size()), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) {
                gather_column(j, hessian);
            }
        });
    }

    /// Place of block (a, b), a <= b.
    static constexpr int pair_index(int a, int b) { return a + b * (b + 1) / 2; }

private:
    void gather_column(Index j, BlockMatrix<Scalar>& hessian) {
        const size_t v = size_t(free_vertices_[size_t(j)]);
        for (std::int32_t k = incidence_offsets_[v]; k < incidence_offsets_[v + 1]; ++k) {
            const std::int32_t incidence = incidences_[size_t(k)];
            const Index s = incidence / num_nodes;
            const int b = incidence % num_nodes;
            for (int a = 0; a < num_nodes; ++a) {
                const std::int32_t rank = ranks_(a, incidence);
                if (rank == PrescribedVertices::prescribed) {
                    continue;
                }
                const int pair = a <= b ? pair_index(a, b) : pair_index(b, a);
                const auto stored = hessian_slots_.template middleCols<3>(3 * (num_block_pairs * s + pair));
                if (a <= b) {
                    hessian.add(j, rank, stored);
                } else {
                    hessian.add(j, rank, stored.transpose());
                }
            }
        }
    }

    Connectivity<num_nodes> stencils_;
    std::vector<std::int32_t> incidence_offsets_;
    std::vector<std::int32_t> incidences_;  // num_nodes * stencil + node, ascending per vertex
    VectorX<Scalar> energy_slots_;
    Matrix3X<Scalar> gradient_slots_;
    Matrix3X<Scalar> hessian_slots_;
    Connectivity<num_nodes> ranks_;
    std::vector<std::int32_t> free_vertices_;
};

}  // namespace softtissue
