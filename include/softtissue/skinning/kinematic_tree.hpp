// SPDX-License-Identifier: MIT
/// @file
/// The tree of joints: who moves whom, and the order in which transforms accumulate.
///
/// What        parent of each joint, checked to be one tree, with an order in which parents come first.
/// Shapes      one entry per joint; the root's parent is no_parent.
/// Refuses     no joint, no or several roots, a parent out of range, a cycle (InvalidInput names the joint).
/// Tests       tests/unit/skinning/kinematic_tree_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

class KinematicTree {
public:
    static constexpr std::int32_t no_parent = -1;

    /// `parents[j]` is the parent joint of j; exactly one joint, the root, has no_parent. Any order is accepted.
    explicit KinematicTree(std::vector<std::int32_t> parents) : parents_(std::move(parents)) {
        require(!parents_.empty(), "kinematic tree: no joints, expected at least one");
        const std::int32_t count = checked_index(Index(parents_.size()), "kinematic tree: joints");
        std::int32_t root = no_parent;
        for (std::int32_t j = 0; j < count; ++j) {
            const std::int32_t parent = parents_[size_t(j)];
            require(parent >= no_parent && parent < count, "kinematic tree: parent of joint ", j, " is ", parent,
                    ", expected -1 (root) to ", count - 1);
            if (parent == no_parent) {
                require(root == no_parent, "kinematic tree: joints ", root, " and ", j,
                        " both have no parent, expected one root");
                root = j;
            }
        }
        require(root != no_parent, "kinematic tree: every joint has a parent, expected one root (a cycle)");
        std::vector<std::int32_t> first_child(parents_.size(), no_parent), next_sibling(parents_.size(), no_parent);
        for (std::int32_t j = count; j-- > 0;) {
            if (j != root) {
                next_sibling[size_t(j)] = first_child[size_t(parents_[size_t(j)])];
                first_child[size_t(parents_[size_t(j)])] = j;
            }
        }
        order_.reserve(parents_.size());
        order_.push_back(root);
        for (size_t next = 0; next < order_.size(); ++next) {
            for (std::int32_t j = first_child[size_t(order_[next])]; j != no_parent; j = next_sibling[size_t(j)]) {
                order_.push_back(j);
            }
        }
        if (order_.size() != parents_.size()) {
            throw_invalid_input("kinematic tree: joint ", unreached_joint(),
                                " does not hang from the root, expected no cycle");
        }
    }

    Index num_joints() const { return static_cast<Index>(parents_.size()); }
    std::int32_t parent(Index joint) const { return parents_[size_t(joint)]; }
    const std::vector<std::int32_t>& parents() const { return parents_; }
    std::int32_t root() const { return order_.front(); }

    /// All joints, each after its parent.
    const std::vector<std::int32_t>& order() const { return order_; }

    bool operator==(const KinematicTree& other) const { return parents_ == other.parents_; }

private:
    std::int32_t unreached_joint() const {
        std::vector<bool> reached(parents_.size(), false);
        for (const std::int32_t j : order_) {
            reached[size_t(j)] = true;
        }
        std::int32_t j = 0;
        while (reached[size_t(j)]) {
            ++j;
        }
        return j;
    }

    std::vector<std::int32_t> parents_;
    std::vector<std::int32_t> order_;
};

}  // namespace softtissue
