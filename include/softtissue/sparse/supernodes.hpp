// SPDX-License-Identifier: MIT
/// @file
/// Supernodes: columns of a Cholesky factor that share the rows below them, to be computed as one dense panel.
///
/// What        the supernodes of a graph eliminated in a given order, children before parents. Two are merged where that stores
///             few zeros: panels then are wide enough for dense arithmetic.
/// Shapes      by vertices of the graph, which count `weights` unknowns each
/// Result      the columns of all supernodes in sequence are the order of elimination; it differs from the given one, yet has
///             the same fill, but for the zeros of merged supernodes.
/// Source      Liu, Ng, Peyton 1993; Ashcraft, Grimes 1989 (relaxed supernodes)
/// Cost        proportional to the entries of the factor by vertices, of which only one column per supernode is kept
/// Tests       tests/unit/sparse/supernodes_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/sparse/block_pattern.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

struct Supernode {
    static constexpr std::int32_t no_parent = -1;

    std::vector<std::int32_t> columns;  ///< vertices in order of elimination
    std::vector<std::int32_t> rows;     ///< vertices below, in order of elimination
    std::int32_t parent = no_parent;    ///< the supernode of rows.front(), which comes later
};

namespace detail {

class SupernodeBuilder {
public:
    SupernodeBuilder(const BlockPattern& graph, std::span<const std::int32_t> order,
                     std::span<const std::int32_t> weights)
        : order_(order), weights_(weights), owner_(order.size()) {
        find(graph);
        link();
        for (size_t s = 0; s < nodes_.size(); ++s) {
            merge_children(s);
        }
    }

    std::vector<Supernode> result() {
        std::vector<size_t> sequence = postorder();
        std::vector<std::int32_t> new_name(nodes_.size());
        std::vector<std::int32_t> place(order_.size());
        std::int32_t next = 0;
        for (size_t k = 0; k < sequence.size(); ++k) {
            new_name[sequence[k]] = static_cast<std::int32_t>(k);
            for (const std::int32_t column : nodes_[sequence[k]].columns) {
                place[size_t(column)] = next++;
            }
        }
        std::vector<Supernode> supernodes;
        supernodes.reserve(sequence.size());
        for (const size_t s : sequence) {
            Node& node = nodes_[s];
            std::sort(node.rows.begin(), node.rows.end(),
                      [&](std::int32_t a, std::int32_t b) { return place[size_t(a)] < place[size_t(b)]; });
            Supernode& supernode = supernodes.emplace_back();
            supernode.columns = to_vertices(std::move(node.columns));
            supernode.rows = to_vertices(std::move(node.rows));
            supernode.parent = node.parent == Supernode::no_parent ? node.parent : new_name[size_t(node.parent)];
        }
        return supernodes;
    }

private:
    /// Columns and rows are places in the given order.
    struct Node {
        std::vector<std::int32_t> columns, rows, children;
        std::int32_t parent = Supernode::no_parent;
        Index width = 0, height = 0, zeros = 0;  // unknowns of columns, of rows, zeros stored so far
        bool is_merged = false;
    };

    Index weight(std::int32_t place) const { return weights_[size_t(order_[size_t(place)])]; }

    /// Eliminates vertex by vertex. The rows of a column are its later neighbours and the rows of its children in the
    /// elimination tree; it continues the supernode of a child that has no other rows.
    void find(const BlockPattern& graph) {
        const std::int32_t n = static_cast<std::int32_t>(order_.size());
        std::vector<std::int32_t> place(order_.size()), seen_by(order_.size(), -1);
        for (std::int32_t k = 0; k < n; ++k) {
            place[size_t(order_[size_t(k)])] = k;
        }
        std::vector<std::vector<std::int32_t>> waiting(order_.size());  // supernodes whose first row is this column
        for (std::int32_t k = 0; k < n; ++k) {
            std::vector<std::int32_t> rows;
            Index height = 0;
            std::int32_t first = n;
            const auto add = [&](std::int32_t row) {
                if (row > k && seen_by[size_t(row)] != k) {
                    seen_by[size_t(row)] = k;
                    rows.push_back(row);
                    height += weight(row);
                    first = std::min(first, row);
                }
            };
            for (const std::int32_t vertex : graph.rows(order_[size_t(k)])) {
                add(place[size_t(vertex)]);
            }
            for (const std::int32_t child : waiting[size_t(k)]) {
                std::for_each(nodes_[size_t(child)].rows.begin(), nodes_[size_t(child)].rows.end(), add);
            }
            const auto same =
                std::find_if(waiting[size_t(k)].begin(), waiting[size_t(k)].end(),
                             [&](std::int32_t child) { return nodes_[size_t(child)].height == height + weight(k); });
            const size_t s = same != waiting[size_t(k)].end() ? size_t(*same) : nodes_.size();
            if (s == nodes_.size()) {
                nodes_.emplace_back();
            }
            Node& node = nodes_[s];
            node.columns.push_back(k);
            node.width += weight(k);
            node.rows = std::move(rows);
            node.height = height;
            owner_[size_t(k)] = static_cast<std::int32_t>(s);
            if (first < n) {
                waiting[size_t(first)].push_back(static_cast<std::int32_t>(s));
            }
            waiting[size_t(k)] = {};
        }
        std::vector<size_t> sequence(nodes_.size());  // by last column: children before parents
        std::iota(sequence.begin(), sequence.end(), size_t(0));
        std::sort(sequence.begin(), sequence.end(),
                  [&](size_t a, size_t b) { return nodes_[a].columns.back() < nodes_[b].columns.back(); });
        std::vector<Node> sorted;
        sorted.reserve(nodes_.size());
        for (const size_t s : sequence) {
            for (const std::int32_t column : nodes_[s].columns) {
                owner_[size_t(column)] = static_cast<std::int32_t>(sorted.size());
            }
            sorted.push_back(std::move(nodes_[s]));
        }
        nodes_ = std::move(sorted);
    }

    void link() {
        for (size_t s = 0; s < nodes_.size(); ++s) {
            if (!nodes_[s].rows.empty()) {
                nodes_[s].parent = owner_[size_t(*std::min_element(nodes_[s].rows.begin(), nodes_[s].rows.end()))];
                nodes_[size_t(nodes_[s].parent)].children.push_back(static_cast<std::int32_t>(s));
            }
        }
    }

    /// Children of a merged child are asked as well.
    void merge_children(size_t s) {
        std::vector<std::int32_t> asked = std::move(nodes_[s].children);
        std::vector<std::int32_t> kept;
        while (!asked.empty()) {
            const std::int32_t c = asked.back();
            asked.pop_back();
            Node& node = nodes_[s];
            Node& child = nodes_[size_t(c)];
            const Index width = node.width + child.width;
            const Index zeros = node.zeros + child.zeros + child.width * (node.width + node.height - child.height);
            if (!is_worth_merging(width, zeros, width * (width + 1) / 2 + width * node.height)) {
                kept.push_back(c);
                continue;
            }
            child.columns.insert(child.columns.end(), node.columns.begin(), node.columns.end());
            node.columns = std::move(child.columns);
            node.width = width;
            node.zeros = zeros;
            asked.insert(asked.end(), child.children.begin(), child.children.end());
            child.is_merged = true;
        }
        for (const std::int32_t c : kept) {
            nodes_[size_t(c)].parent = static_cast<std::int32_t>(s);
        }
        std::sort(kept.begin(), kept.end());
        nodes_[s].children = std::move(kept);
    }

    /// The narrower a panel, the more zeros it may hold. Found by measurement on solid meshes.
    static bool is_worth_merging(Index width, Index zeros, Index entries) {
        const double share = double(zeros) / double(entries);
        return zeros == 0 || (width <= 12 && share < 0.8) || (width <= 24 && share < 0.4) ||
               (width <= 64 && share < 0.12) || share < 0.04;
    }

    std::vector<size_t> postorder() const {
        std::vector<size_t> sequence, stack;
        for (size_t s = nodes_.size(); s-- > 0;) {
            if (!nodes_[s].is_merged && nodes_[s].parent == Supernode::no_parent) {
                stack.push_back(s);
            }
        }
        // parents first, last children first; then backwards
        std::reverse(stack.begin(), stack.end());
        while (!stack.empty()) {
            const size_t s = stack.back();
            stack.pop_back();
            sequence.push_back(s);
            stack.insert(stack.end(), nodes_[s].children.begin(), nodes_[s].children.end());
        }
        std::reverse(sequence.begin(), sequence.end());
        return sequence;
    }

    std::vector<std::int32_t> to_vertices(std::vector<std::int32_t> places) const {
        for (std::int32_t& place : places) {
            place = order_[size_t(place)];
        }
        return places;
    }

    std::span<const std::int32_t> order_, weights_;
    std::vector<Node> nodes_;
    std::vector<std::int32_t> owner_;
};

}  // namespace detail

/// `order[k]` is the vertex eliminated as the k-th, `weights[v]` the number of unknowns of vertex v.
inline std::vector<Supernode> make_supernodes(const BlockPattern& graph, std::span<const std::int32_t> order,
                                              std::span<const std::int32_t> weights) {
    SOFTTISSUE_ASSERT(Index(order.size()) == graph.num_columns() && order.size() == weights.size());
    return detail::SupernodeBuilder(graph, order, weights).result();
}

}  // namespace softtissue
