// SPDX-License-Identifier: MIT
/// @file
/// Adds the gradients of stencils to vertices, part by part.
///
/// What        some hundred stencils, a part, add up what belongs to each of their vertices; then the sums of the parts are added
///             vertex by vertex: ascending stencils within a part, ascending parts, the same bits for every executor.
/// Shapes      slots of N stencils, a pack: N columns of four numbers, the last of which is ignored, for node 0, then N for node 1, ...
/// Why         the numbers of a stencil never leave the nearest cache, a column is one addition, and parts need no lock
/// Memory      int32[num_nodes] per stencil, Scalar[4] and an int32 per vertex of a part
/// Tests       tests/unit/energy/gradient_parts_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace softtissue {

template <int num_nodes, RealScalar Scalar>
class GradientParts {
public:
    /// Stencils of a part.
    static constexpr Index part = 512;

    /// Place of a column in the slots of a pack of N stencils.
    template <int N>
    static constexpr Index column_offset(int node, int lane) {
        return 4 * (Index(N) * node + lane);
    }

    /// The gradient of one of them, 3 x num_nodes.
    template <int N>
    static auto gradient_in(Scalar* slots, int lane) {
        return Eigen::Map<Eigen::Matrix<Scalar, 3, num_nodes>, 0, Eigen::OuterStride<4 * N>>(slots +
                                                                                             column_offset<N>(0, lane));
    }

    GradientParts(const Connectivity<num_nodes>& stencils, Index num_vertices)
        : num_vertices_(num_vertices), columns_(num_nodes, stencils.cols()) {
        checked_index(num_nodes * stencils.cols(), "energy: nodes of all its cells");
        for (Index first = 0; first < stencils.cols(); first += part) {
            const auto nodes = stencils.middleCols(first, std::min(part, stencils.cols() - first)).reshaped();
            std::vector<std::int32_t> own(nodes.begin(), nodes.end());
            std::sort(own.begin(), own.end());
            own.erase(std::unique(own.begin(), own.end()), own.end());
            for (Index k = 0; k < nodes.size(); ++k) {
                const auto at = std::lower_bound(own.begin(), own.end(), nodes(k));
                columns_.data()[num_nodes * first + k] =
                    static_cast<std::int32_t>(offsets_.back() + (at - own.begin()));
            }
            vertices_.insert(vertices_.end(), own.begin(), own.end());
            offsets_.push_back(Index(vertices_.size()));
        }
        sums_.resize(4, Index(vertices_.size()));
    }

    Index num_stencils() const { return columns_.cols(); }
    Index num_vertices() const { return num_vertices_; }

    /// `fill(pack, slots)` writes the slots of stencils N pack to N pack + N - 1; what it writes for stencils beyond the last is
    /// ignored. The sums are added to `gradient`, 3 x num_vertices.
    template <int N, Executor E, class Fill>
    void add(const E& executor, const Fill& fill, Matrix3X<Scalar>& gradient) {
        static_assert(part % N == 0);
        executor.for_each_range(num_parts(), [&](Index begin, Index end) {
            Scalar slots[std::size_t(4 * num_nodes * N)] = {};
            for (Index p = begin; p < end; ++p) {
                sums_.middleCols(offsets_[size_t(p)], offsets_[size_t(p) + 1] - offsets_[size_t(p)]).setZero();
                const Index last = std::min(part * (p + 1), num_stencils());
                for (Index s = part * p; s < last; s += N) {
                    fill(s / N, slots);
                    add_pack<N>(s, int(std::min<Index>(N, last - s)), slots);
                }
            }
        });
        executor.for_each_range(num_vertices_, [&](Index begin, Index end) {
            for (Index p = 0; p < num_parts(); ++p) {
                const auto at = [&](Index vertex) {
                    return std::lower_bound(vertices_.begin() + offsets_[size_t(p)],
                                            vertices_.begin() + offsets_[size_t(p) + 1], vertex) -
                           vertices_.begin();
                };
                for (Index k = at(begin), last = at(end); k < last; ++k) {
                    gradient.col(vertices_[size_t(k)]) += sums_.col(k).template head<3>();
                }
            }
        });
    }

private:
    Index num_parts() const { return Index(offsets_.size()) - 1; }

    template <int N>
    void add_pack(Index first, int count, const Scalar* slots) {
        using Column = Pack<Scalar, 4>;
        for (int lane = 0; lane < count; ++lane) {
            for (int a = 0; a < num_nodes; ++a) {
                Scalar* const sum = sums_.data() + 4 * Index(columns_(a, first + lane));
                Column(Column::load(sum) + Column::load(slots + column_offset<N>(a, lane))).store(sum);
            }
        }
    }

    Index num_vertices_;
    Connectivity<num_nodes> columns_;     // of sums_, where the nodes of each stencil are added up
    std::vector<std::int32_t> vertices_;  // of each column of sums_, ascending within a part
    std::vector<Index> offsets_{0};       // of each part's columns
    Eigen::Matrix<Scalar, 4, Eigen::Dynamic> sums_;
};

}  // namespace softtissue
