// SPDX-License-Identifier: MIT
/// @file
/// Adds the Hessians of stencils to a block matrix, tile by tile.
///
/// What        those of some hundred stencils, a tile, are written into slots and added while they lie in the cache: column by column
///             in ascending stencil order, the same bits for every executor.
/// Shapes      slot of a stencil: blocks (a, b), a <= b, 3x3 each, column-major, of a symmetric Hessian. N stencils, a pack, have their slots
///             together, block by block: the N blocks (0, 0), then the N blocks (0, 1), ...
/// Memory      int32[num_nodes^2 + num_nodes] per stencil; half a MiB for the slots
/// Cost        bound by the matrix, of which a tile reads and writes the columns of its vertices: their memory is asked for ahead
/// Tests       tests/unit/energy/hessian_tiles_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <int num_nodes, RealScalar Scalar>
class HessianTiles {
public:
    static constexpr int num_block_pairs = num_nodes * (num_nodes + 1) / 2;
    static constexpr Index slot_size = 9 * num_block_pairs;

    /// Stencils of a tile: as many as stay in a core's cache.
    static constexpr Index tile = std::max<Index>(64, (Index(1) << 19) / Index(slot_size * sizeof(Scalar)) / 64 * 64);

    /// Number of the pair (a, b), a <= b.
    static constexpr int pair_index(int a, int b) { return a + b * (b + 1) / 2; }

    /// Place of a block of one lane in the slots of a pack of N stencils.
    template <int N>
    static constexpr Index block_offset(int pair, int lane) {
        return 9 * (Index(N) * pair + lane);
    }

    /// Looks up where every block goes; once per pattern, before add().
    void bind(const Connectivity<num_nodes>& stencils, const PrescribedVertices& prescribed,
              const BlockPattern& pattern) {
        num_stencils_ = stencils.cols();
        runs_.clear();
        tile_runs_.assign(1, 0);
        incidences_.clear();
        ranks_.resize(num_nodes, stencils.size());
        std::vector<std::pair<std::int32_t, std::int32_t>> columns;  // with what adds to them, of a tile
        for (Index first = 0; first < num_stencils_; first += tile) {
            columns.clear();
            for (Index k = num_nodes * first; k < num_nodes * std::min(first + tile, num_stencils_); ++k) {
                const std::int32_t column = prescribed.free_index(stencils.data()[k]);
                if (column != PrescribedVertices::prescribed) {
                    columns.emplace_back(column, static_cast<std::int32_t>(k));
                }
            }
            std::sort(columns.begin(), columns.end());
            for (const auto& [column, incidence] : columns) {
                const auto k = static_cast<std::int32_t>(incidences_.size());
                if (Index(runs_.size()) == tile_runs_.back() || runs_.back().column != column) {
                    runs_.push_back({column, k, k});
                }
                ++runs_.back().end;
                for (int a = 0; a < num_nodes; ++a) {
                    const std::int32_t row = prescribed.free_index(stencils(a, incidence / num_nodes));
                    ranks_(a, k) = row == PrescribedVertices::prescribed ? row : pattern.rank(column, row);
                }
                incidences_.push_back(incidence);
            }
            tile_runs_.push_back(Index(runs_.size()));
        }
        slots_.resize(slot_size * std::min(tile, (num_stencils_ + 63) / 64 * 64));
    }

    /// `fill(first, count, slots)` writes the slots of stencils `first` to `first + count - 1`, in packs of N; the last pack is padded.
    template <int N, Executor E, class Fill>
    void add(const E& executor, const Fill& fill, BlockMatrix<Scalar>& hessian) {
        static_assert(64 % N == 0);
        SOFTTISSUE_ASSERT(!tile_runs_.empty());
        for (Index t = 0; t + 1 < Index(tile_runs_.size()); ++t) {
            const Index first = t * tile;
            fill(first, std::min(tile, num_stencils_ - first), slots_.data());
            const Index first_run = tile_runs_[size_t(t)];
            executor.for_each_range(tile_runs_[size_t(t) + 1] - first_run, [&](Index begin, Index end) {
                for (Index r = first_run + begin; r < first_run + end; ++r) {
                    if (r + runs_ahead < Index(runs_.size())) {
                        hessian.column(runs_[size_t(r + runs_ahead)].column).prefetch();
                    }
                    add_run<N>(runs_[size_t(r)], first, hessian);
                }
            });
        }
    }

private:
    /// The incidences of one column's vertex with the stencils of one tile.
    struct Run {
        std::int32_t column;
        std::int32_t begin;
        std::int32_t end;
    };

    /// How far ahead the memory of columns is asked for.
    static constexpr Index runs_ahead = 3;

    template <int N>
    void add_run(const Run& run, Index first_stencil, BlockMatrix<Scalar>& hessian) const {
        using Strides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
        using BlockOrTranspose = Eigen::Map<const Matrix3<Scalar>, 0, Strides>;
        const auto column = hessian.column(run.column);
        for (std::int32_t k = run.begin; k < run.end; ++k) {
            const std::int32_t incidence = incidences_[size_t(k)];
            const Index s = incidence / num_nodes - first_stencil;
            const int b = incidence % num_nodes;
            const Scalar* const slots = slots_.data() + slot_size * (s / N * N);
            for (int a = 0; a < num_nodes; ++a) {
                const std::int32_t rank = ranks_(a, k);
                if (rank == PrescribedVertices::prescribed) {
                    continue;
                }
                const bool is_block = a <= b;
                const int pair = is_block ? pair_index(a, b) : pair_index(b, a);
                column.add(rank, BlockOrTranspose(slots + block_offset<N>(pair, int(s % N)),
                                                  is_block ? Strides(3, 1) : Strides(1, 3)));
            }
        }
    }

    Index num_stencils_ = 0;
    VectorX<Scalar> slots_;                 // of one tile
    std::vector<Run> runs_;                 // ascending tile, then column
    std::vector<Index> tile_runs_;          // where the runs of each tile begin
    std::vector<std::int32_t> incidences_;  // num_nodes * stencil + node, in the order of runs
    Connectivity<num_nodes> ranks_;         // of each of them
};

}  // namespace softtissue
