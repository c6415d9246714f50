// SPDX-License-Identifier: MIT
/// @file
/// A tree of axis-aligned boxes over items that have boxes of their own: triangles, cells, points.
///
/// What        which items' boxes hold a point or overlap a box, which item is nearest to a point, which pairs of items
///             of one tree or of two have overlapping boxes.
/// Method      halves of equal size along the longest axis of the items' centres, equal centres by item number. The nodes
///             are stored in pre-order, each with the number of the node behind its subtree: a query runs through them
///             and skips.
/// Shapes      one box per item; items and nodes are numbered from 0; node 0 is the root.
/// Valid       boxes are closed: what touches overlaps. Boxes without volume are as good as any. Visitors see items in
///             the order of the tree, the same on every platform. A point that is not finite lies in no box.
/// Refuses     a box that is empty or not finite (InvalidInput names it), refit() with another number of boxes.
/// Cost        build O(n log n), refit O(n); queries allocate nothing, and take O(log n) where few boxes overlap.
/// Tests       tests/unit/mesh/bounding_volume_hierarchy_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
using Box = Eigen::AlignedBox<S, 3>;

template <RealScalar S>
class BoundingVolumeHierarchy {
public:
    static constexpr std::int32_t no_item = -1;
    static constexpr std::int32_t leaf_size = 4;

    /// Slots begin .. end - 1 of slot_items() lie in `box`. Its children, if it has any, are the node behind it and the
    /// node behind the subtree of that one.
    struct Node {
        Box<S> box;
        std::int32_t begin, end;
        std::int32_t next;  ///< the node behind this one's subtree

        bool is_leaf() const { return end - begin <= leaf_size; }
    };

    /// The item nearest to a point.
    struct Nearest {
        std::int32_t item;  ///< no_item if there is none
        S squared_distance;
    };

    explicit BoundingVolumeHierarchy(const std::vector<Box<S>>& boxes) : boxes_(boxes.size()) {
        check(boxes);
        std::vector<Entry> entries(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            entries[i] = {boxes[i].center(), static_cast<std::int32_t>(i)};
        }
        if (!boxes.empty()) {
            build(entries, 0, static_cast<std::int32_t>(boxes.size()));
        }
        slot_items_.reserve(boxes.size());
        for (const Entry& entry : entries) {
            slot_items_.push_back(entry.item);
        }
        fill(boxes);
    }

    /// New boxes for the same items: the tree stays, its boxes follow.
    void refit(const std::vector<Box<S>>& boxes) {
        require(boxes.size() == slot_items_.size(), "hierarchy: ", boxes.size(), " boxes, expected ",
                slot_items_.size());
        check(boxes);
        fill(boxes);
    }

    Index num_items() const { return static_cast<Index>(slot_items_.size()); }
    const std::vector<Node>& nodes() const { return nodes_; }

    /// The item in each slot.
    const std::vector<std::int32_t>& slot_items() const { return slot_items_; }

    /// visit(item) for each item whose box holds `p`.
    template <class Visit>
    void for_each_containing(const Vector3<S>& p, const Visit& visit) const {
        for_each_item([&p](const Box<S>& box) { return box.contains(p); }, visit);
    }

    /// visit(item) for each item whose box overlaps `box`.
    template <class Visit>
    void for_each_overlapping(const Box<S>& box, const Visit& visit) const {
        for_each_item([&box](const Box<S>& other) { return box.intersects(other); }, visit);
    }

    /// The item with the smallest squared_distance(item) below squared(`within`); squared_distance must not be smaller
    /// than the squared distance from `p` to the item's box. Of equally near items the one with the smallest number.
    template <class SquaredDistance>
    Nearest nearest(const Vector3<S>& p, const SquaredDistance& squared_distance,
                    S within = std::numeric_limits<S>::infinity()) const {
        Nearest best{no_item, within * within};
        // Depth first, the nearer child first: one postponed sibling a level.
        std::array<std::pair<S, std::int32_t>, max_depth> postponed;
        std::size_t count = 0;
        const auto postpone = [&](std::int32_t node) {
            postponed[count++] = {nodes_[size_t(node)].box.squaredExteriorDistance(p), node};
        };
        if (!nodes_.empty()) {
            postpone(0);
        }
        while (count > 0) {
            const auto [node_distance, number] = postponed[--count];
            if (node_distance > best.squared_distance) {
                continue;
            }
            const Node& node = nodes_[size_t(number)];
            if (!node.is_leaf()) {
                postpone(number + 1);
                postpone(nodes_[size_t(number) + 1].next);
                if (postponed[count - 2].first < postponed[count - 1].first) {
                    std::swap(postponed[count - 2], postponed[count - 1]);
                }
                continue;
            }
            for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
                if (boxes_[size_t(slot)].squaredExteriorDistance(p) > best.squared_distance) {
                    continue;
                }
                const std::int32_t item = slot_items_[size_t(slot)];
                const S distance = squared_distance(item);
                if (distance < best.squared_distance || (distance == best.squared_distance && item < best.item)) {
                    best = {item, distance};
                }
            }
        }
        return best;
    }

    /// visit(i, j), i < j, for each pair of items whose boxes overlap.
    template <class Visit>
    void for_each_overlapping_pair(const Visit& visit) const {
        for_each_pair(*this, [&visit](std::int32_t i, std::int32_t j) { visit(std::min(i, j), std::max(i, j)); });
    }

    /// visit(i, j) for each item i of this tree and j of `other` whose boxes overlap.
    template <class Visit>
    void for_each_overlapping_pair(const BoundingVolumeHierarchy& other, const Visit& visit) const {
        for_each_pair(other, visit);
    }

private:
    /// Halving 2^31 items gives 31 levels.
    static constexpr std::size_t max_depth = 34;

    struct Entry {
        Vector3<S> centre;
        std::int32_t item;
    };

    static void check(const std::vector<Box<S>>& boxes) {
        checked_index(2 * Index(boxes.size()), "hierarchy: nodes");
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Box<S>& box = boxes[i];
            require(box.min().allFinite() && box.max().allFinite() && !box.isEmpty(), "hierarchy: box ", i,
                    " is empty or not finite");
        }
    }

    void build(std::vector<Entry>& entries, std::int32_t begin, std::int32_t end) {
        const std::size_t number = nodes_.size();
        nodes_.push_back({Box<S>(), begin, end, 0});
        if (nodes_[number].is_leaf()) {
            std::sort(entries.begin() + begin, entries.begin() + end,
                      [](const Entry& a, const Entry& b) { return a.item < b.item; });
        } else {
            Box<S> centres;
            for (std::int32_t slot = begin; slot < end; ++slot) {
                centres.extend(entries[size_t(slot)].centre);
            }
            Index axis = 0;
            centres.sizes().maxCoeff(&axis);
            const std::int32_t middle = begin + (end - begin) / 2;
            std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end,
                             [axis](const Entry& a, const Entry& b) {
                                 return std::pair(a.centre(axis), a.item) < std::pair(b.centre(axis), b.item);
                             });
            build(entries, begin, middle);
            build(entries, middle, end);
        }
        nodes_[number].next = static_cast<std::int32_t>(nodes_.size());
    }

    /// Children stand behind their parents: from the back, each node finds its children done.
    void fill(const std::vector<Box<S>>& boxes) {
        for (std::size_t slot = 0; slot < boxes_.size(); ++slot) {
            boxes_[slot] = boxes[size_t(slot_items_[slot])];
        }
        for (std::size_t k = nodes_.size(); k-- > 0;) {
            Node& node = nodes_[k];
            if (node.is_leaf()) {
                node.box = boxes_[size_t(node.begin)];
                for (std::int32_t slot = node.begin + 1; slot < node.end; ++slot) {
                    node.box.extend(boxes_[size_t(slot)]);
                }
            } else {
                node.box = nodes_[k + 1].box.merged(nodes_[size_t(nodes_[k + 1].next)].box);
            }
        }
    }

    template <class Matches, class Visit>
    void for_each_item(const Matches& matches, const Visit& visit) const {
        for (std::size_t k = 0; k < nodes_.size();) {
            const Node& node = nodes_[k];
            if (!matches(node.box)) {
                k = size_t(node.next);
                continue;
            }
            if (node.is_leaf()) {
                for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
                    if (matches(boxes_[size_t(slot)])) {
                        visit(slot_items_[size_t(slot)]);
                    }
                }
            }
            ++k;
        }
    }

    /// Within one tree (`other` is this one) each pair once: subtrees other than the same one have no common item.
    template <class Visit>
    void for_each_pair(const BoundingVolumeHierarchy& other, const Visit& visit) const {
        // Each step down in one of the trees postpones at most two pairs.
        std::array<std::pair<std::int32_t, std::int32_t>, 4 * max_depth> postponed;
        std::size_t count = 0;
        if (!nodes_.empty() && !other.nodes_.empty()) {
            postponed[count++] = {0, 0};
        }
        while (count > 0) {
            const auto [a, b] = postponed[--count];
            const Node& left = nodes_[size_t(a)];
            const Node& right = other.nodes_[size_t(b)];
            if (!left.box.intersects(right.box)) {
                continue;
            }
            const bool is_same = this == &other && a == b;
            if (left.is_leaf() && right.is_leaf()) {
                visit_slots(left, other, right, is_same, visit);
            } else if (is_same) {
                const std::int32_t second = nodes_[size_t(a) + 1].next;
                postponed[count++] = {second, second};
                postponed[count++] = {a + 1, second};
                postponed[count++] = {a + 1, a + 1};
            } else if (right.is_leaf() ||
                       (!left.is_leaf() && left.box.sizes().maxCoeff() >= right.box.sizes().maxCoeff())) {
                postponed[count++] = {nodes_[size_t(a) + 1].next, b};
                postponed[count++] = {a + 1, b};
            } else {
                postponed[count++] = {a, other.nodes_[size_t(b) + 1].next};
                postponed[count++] = {a, b + 1};
            }
        }
    }

    template <class Visit>
    void visit_slots(const Node& left, const BoundingVolumeHierarchy& other, const Node& right, bool is_same,
                     const Visit& visit) const {
        for (std::int32_t i = left.begin; i < left.end; ++i) {
            for (std::int32_t j = is_same ? i + 1 : right.begin; j < right.end; ++j) {
                if (boxes_[size_t(i)].intersects(other.boxes_[size_t(j)])) {
                    visit(slot_items_[size_t(i)], other.slot_items_[size_t(j)]);
                }
            }
        }
    }

    std::vector<Node> nodes_;
    std::vector<std::int32_t> slot_items_;
    std::vector<Box<S>> boxes_;  // by slot
};

}  // namespace softtissue
