// SPDX-License-Identifier: MIT
/// @file
/// From stencils to vertices: slots per stencil, gathered in a fixed order.
///
/// What        every stencil (a cell, a hinge, ...) of num_nodes vertices writes its gradient and Hessian into slots of its own;
///             a gather then adds the slots vertex by vertex in ascending stencil order: the same bits for every executor.
///             Hessians go tile by tile (hessian_tiles.hpp).
/// Packs       N stencils at a time, evaluated together, written one after the other; the last pack is padded.
/// Shapes      gradient slot 3 x num_nodes; Hessian slot: blocks (a, b), a <= b, 3x3 each, of a symmetric stencil Hessian.
/// Memory      Scalar[3 num_nodes + 1] and int32[3 num_nodes] per stencil, and what HessianTiles needs
/// Tests       tests/unit/energy/stencil_assembly_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/config.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/hessian_tiles.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <algorithm>
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

    using GradientSlot = Eigen::Matrix<Scalar, 3, num_nodes>;

    StencilAssembly(Connectivity<num_nodes> stencils, Index num_vertices)
        : stencils_(std::move(stencils)),
          energy_slots_(padded(stencils_.cols())),
          gradient_slots_(3, num_nodes * padded(stencils_.cols())) {
        checked_index(num_nodes * num_stencils(), "energy: nodes of all its cells");
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

    /// Calls `energy_of(stencil)` for each stencil; returns the sum, added in a fixed order.
    template <Executor E, class EnergyOf>
    Scalar sum_energy(const E& executor, const EnergyOf& energy_of) {
        return sum_packed_energy<1>(executor, [&](Index s, Scalar* slot) { *slot = energy_of(s); });
    }

    /// Calls `gradient_of(stencil) -> GradientSlot` for each stencil and adds the results to `gradient`, 3 x num_vertices.
    template <Executor E, class GradientOf>
    void add_gradient(const E& executor, const GradientOf& gradient_of, Matrix3X<Scalar>& gradient) {
        add_packed_gradient<1>(
            executor, [&](Index s, Scalar* slot) { Eigen::Map<GradientSlot>{slot} = gradient_of(s); }, gradient);
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

    /// The same with a GradientSlot for each stencil, one after the other.
    template <int N, Executor E, class GradientsOf>
    void add_packed_gradient(const E& executor, const GradientsOf& gradients_of, Matrix3X<Scalar>& gradient) {
        fill_slots<N>(executor, 0, num_stencils(), gradients_of, gradient_slots_.data(), 3 * num_nodes);
        gather_gradient_slots(executor, gradient);
    }

    /// Both at once: calls `terms_of(pack, energies, gradients)`.
    template <int N, Executor E, class TermsOf>
    Scalar add_packed_energy_and_gradient(const E& executor, const TermsOf& terms_of, Matrix3X<Scalar>& gradient) {
        fill_slots<N>(
            executor, 0, num_stencils(),
            [&](Index pack, Scalar* energies) {
                terms_of(pack, energies, gradient_slots_.data() + 3 * num_nodes * N * pack);
            },
            energy_slots_.data(), 1);
        gather_gradient_slots(executor, gradient);
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
        tiles_.bind(stencils_, incidence_offsets_, incidences_, prescribed, pattern);
    }

private:
    /// Room for the last pack.
    static constexpr Index padded(Index num_stencils) { return (num_stencils + 63) / 64 * 64; }

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

    template <Executor E>
    void gather_gradient_slots(const E& executor, Matrix3X<Scalar>& gradient) const {
        executor.for_each_range(num_vertices(), [&](Index begin, Index end) {
            for (Index v = begin; v < end; ++v) {
                Vector3<Scalar> sum = gradient.col(v);
                for (std::int32_t k = incidence_offsets_[size_t(v)]; k < incidence_offsets_[size_t(v) + 1]; ++k) {
                    sum += gradient_slots_.col(incidences_[size_t(k)]);
                }
                gradient.col(v) = sum;
            }
        });
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
    std::vector<std::int32_t> incidence_offsets_;
    std::vector<std::int32_t> incidences_;  // num_nodes * stencil + node, ascending per vertex
    VectorX<Scalar> energy_slots_;
    Matrix3X<Scalar> gradient_slots_;
    Tiles tiles_;
};

}  // namespace softtissue
