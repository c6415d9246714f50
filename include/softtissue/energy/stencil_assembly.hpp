// SPDX-License-Identifier: MIT
/// @file
/// From stencils to vertices: energies, gradients and Hessians added up in a fixed order.
///
/// What        every stencil (a cell, a hinge, ...) of num_nodes vertices writes its energy, gradient and Hessian into slots, which are
///             added up in a fixed order: the same bits for every executor. Gradients go part by part (gradient_parts.hpp),
///             Hessians tile by tile (hessian_tiles.hpp).
/// Packs       N stencils at a time, evaluated together; the last pack is padded.
/// Shapes      gradient 3 x num_nodes; Hessian slot: blocks (a, b), a <= b, 3x3 each, of a symmetric stencil Hessian.
/// Memory      a Scalar per stencil, and what GradientParts and HessianTiles need
/// Tests       tests/unit/energy/stencil_assembly_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/gradient_parts.hpp>
#include <softtissue/energy/hessian_tiles.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <int num_nodes_, RealScalar S>
class StencilAssembly {
public:
    using Scalar = S;
    static constexpr int num_nodes = num_nodes_;
    using Tiles = HessianTiles<num_nodes, Scalar>;
    static constexpr int num_block_pairs = Tiles::num_block_pairs;

    using Gradients = GradientParts<num_nodes, Scalar>;

    using GradientSlot = Eigen::Matrix<Scalar, 3, num_nodes>;

    StencilAssembly(Connectivity<num_nodes> stencils, Index num_vertices)
        : stencils_(std::move(stencils)),
          gradients_(stencils_, num_vertices),
          energy_slots_((num_stencils() + 63) / 64 * 64) {}

    Index num_stencils() const { return stencils_.cols(); }
    Index num_vertices() const { return gradients_.num_vertices(); }
    const Connectivity<num_nodes>& stencils() const { return stencils_; }

    /// Calls `energy_of(stencil)` for each stencil; returns the sum, added in a fixed order.
    template <Executor E, class EnergyOf>
    Scalar sum_energy(const E& executor, const EnergyOf& energy_of) {
        return sum_packed_energy<1>(executor, [&](Index s, Scalar* slot) { *slot = energy_of(s); });
    }

    /// Calls `gradient_of(stencil) -> GradientSlot` for each stencil and adds the results to `gradient`, 3 x num_vertices.
    template <Executor E, class GradientOf>
    void add_gradient(const E& executor, const GradientOf& gradient_of, Matrix3X<Scalar>& gradient) {
        add_packed_gradient<1>(
            executor, [&](Index s, Scalar* slots) { Gradients::template gradient_in<1>(slots, 0) = gradient_of(s); },
            gradient);
    }

    /// Calls `hessian_of(stencil, blocks)` for each stencil, which fills `blocks` (3 x 3 num_block_pairs; block (a, b), a <= b,
    /// at Tiles::pair_index(a, b)) and adds the results to `hessian`. Needs bind().
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
        using Blocks = Eigen::Map<Eigen::Matrix<Scalar, 3, 3 * num_block_pairs>>;
        tiles_.template add<1>(
            executor,
            [&](Index first, Index count, Scalar* slots) {
                executor.for_each_range(count, [&](Index begin, Index end) {
                    fill(first + begin, first + end,
                         [&](Index s) { return Blocks(slots + Tiles::slot_size * (s - first)); });
                });
            },
            hessian);
    }

    /// Calls `energies_of(pack, slots)`, which writes the energies of stencils N pack to N pack + N - 1; what it writes for
    /// stencils beyond the last is ignored.
    template <int N, Executor E, class EnergiesOf>
    Scalar sum_packed_energy(const E& executor, const EnergiesOf& energies_of) {
        fill_slots<N>(executor, 0, num_stencils(), energies_of, energy_slots_.data(), 1);
        return sum_of_energy_slots();
    }

    /// The same with gradients, pack by pack: Gradients::column_offset<N>(node, lane) is the place of three numbers.
    template <int N, Executor E, class GradientsOf>
    void add_packed_gradient(const E& executor, const GradientsOf& gradients_of, Matrix3X<Scalar>& gradient) {
        gradients_.template add<N>(executor, gradients_of, gradient);
    }

    /// Both at once: calls `terms_of(pack, energies, gradients)`.
    template <int N, Executor E, class TermsOf>
    Scalar add_packed_energy_and_gradient(const E& executor, const TermsOf& terms_of, Matrix3X<Scalar>& gradient) {
        gradients_.template add<N>(
            executor,
            [&](Index pack, Scalar* gradients) { terms_of(pack, energy_slots_.data() + N * pack, gradients); },
            gradient);
        return sum_of_energy_slots();
    }

    /// The same with the blocks of add_hessian(), pack by pack: Tiles::block_offset<N>(Tiles::pair_index(a, b), lane) is their place.
    template <int N, Executor E, class HessiansOf>
    void add_packed_hessian(const E& executor, const HessiansOf& hessians_of, BlockMatrix<Scalar>& hessian) {
        tiles_.template add<N>(
            executor,
            [&](Index first, Index count, Scalar* slots) {
                fill_slots<N>(executor, first, count, hessians_of, slots, Tiles::slot_size);
            },
            hessian);
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
        tiles_.bind(stencils_, prescribed, pattern);
    }

private:
    Scalar sum_of_energy_slots() {
        using Lanes = Pack<Scalar, natural_lanes<Scalar>>;
        energy_slots_.tail(energy_slots_.size() - num_stencils()).setZero();
        Lanes sums(0);
        for (Index s = 0; s < num_stencils(); s += num_lanes<Lanes>) {
            sums += Lanes::load(energy_slots_.data() + s);
        }
        Scalar sum(0);
        for (int i = 0; i < num_lanes<Lanes>; ++i) {
            sum += sums[i];
        }
        return sum;
    }

    template <int N, Executor E, class Fill>
    static void fill_slots(const E& executor, Index first, Index count, const Fill& fill, Scalar* slots,
                           Index slot_size) {
        executor.for_each_range((count + N - 1) / N, [&](Index begin, Index end) {
            for (Index p = begin; p < end; ++p) {
                fill(first / N + p, slots + N * p * slot_size);
            }
        });
    }

    Connectivity<num_nodes> stencils_;
    Gradients gradients_;
    VectorX<Scalar> energy_slots_;  // with room for the last pack
    Tiles tiles_;
};

}  // namespace softtissue
