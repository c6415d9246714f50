// SPDX-License-Identifier: MIT
/// @file
/// The nodes of the cells of a mesh in packs of cells, to gather positions with.
///
/// What        cell c in lane c % width of pack c / width; the lanes beyond the last cell repeat it
/// Shapes      x 3 x vertices; gathered 3 x num_nodes of packs
/// Why         a pack's node numbers lie together and are turned into places of numbers once
/// Memory      4 num_nodes bytes a cell, 4 a pack
/// Tests       tests/unit/energy/node_packs_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_columns.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

template <int num_nodes, int width>
class NodePacks {
public:
    explicit NodePacks(const Connectivity<num_nodes>& cells) : num_cells_(cells.cols()) {
        places_.reserve(size_t(num_nodes * width * num_packs()));
        for (Index p = 0; p < num_packs(); ++p) {
            for (int a = 0; a < num_nodes; ++a) {
                for (int i = 0; i < width; ++i) {
                    places_.push_back(3 * cells(a, cell(p, i)));
                }
            }
            largest_places_.push_back(*std::max_element(places_.end() - num_nodes * width, places_.end()));
        }
    }

    Index num_cells() const { return num_cells_; }
    Index num_packs() const { return (num_cells_ + width - 1) / width; }

    /// The cell in a lane of a pack.
    Index cell(Index pack, int lane) const { return std::min(width * pack + lane, num_cells_ - 1); }

    /// The columns of x at the nodes of a pack's cells.
    template <RealScalar S>
    Eigen::Matrix<Pack<S, width>, 3, num_nodes> gather(const Matrix3X<S>& x, Index pack) const {
        SOFTTISSUE_ASSERT(pack >= 0 && pack < num_packs());
        const std::int32_t* const places = places_.data() + num_nodes * width * pack;
        Eigen::Matrix<Pack<S, width>, 3, num_nodes> result;
        const bool has_last = largest_places_[size_t(pack)] + 3 == x.size();
        for (int a = 0; a < num_nodes; ++a) {
            const std::int32_t* const of_node = places + a * width;
            result.col(a) =
                has_last ? gather_last_columns<width>(x.data(), of_node) : gather_columns<width>(x.data(), of_node);
        }
        return result;
    }

private:
    Index num_cells_;
    std::vector<std::int32_t> places_;          // three times the vertex, lane by lane, node by node
    std::vector<std::int32_t> largest_places_;  // of each pack
};

}  // namespace softtissue
