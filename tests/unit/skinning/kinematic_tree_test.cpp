// SPDX-License-Identifier: MIT
#include <softtissue/skinning/kinematic_tree.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

TEST_CASE("parents come before children in any numbering") {
    const KinematicTree tree({2, 0, -1, 1, 2});
    CHECK(tree.num_joints() == 5);
    CHECK(tree.root() == 2);
    CHECK(tree.parent(3) == 1);
    CHECK(tree.parents() == std::vector<std::int32_t>{2, 0, -1, 1, 2});
    std::vector<bool> seen(5, false);
    for (const std::int32_t j : tree.order()) {
        CHECK((tree.parent(j) == KinematicTree::no_parent || seen[size_t(tree.parent(j))]));
        CHECK_FALSE(seen[size_t(j)]);
        seen[size_t(j)] = true;
    }
    CHECK(tree.order().size() == 5);
    CHECK(tree == KinematicTree({2, 0, -1, 1, 2}));
    CHECK_FALSE(tree == KinematicTree({-1}));
}

TEST_CASE("what is no tree is refused, with the joint") {
    CHECK_THROWS_WITH_AS(KinematicTree({}), "kinematic tree: no joints, expected at least one", InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({-1, 2}), "kinematic tree: parent of joint 1 is 2, expected -1 (root) to 1",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({-1, -2}), "kinematic tree: parent of joint 1 is -2, expected -1 (root) to 1",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({-1, 0, -1}),
                         "kinematic tree: joints 0 and 2 both have no parent, expected one root", InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({1, 0}),
                         "kinematic tree: every joint has a parent, expected one root (a cycle)", InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({-1, 0, 3, 2}),
                         "kinematic tree: joint 2 does not hang from the root, expected no cycle", InvalidInput);
    CHECK_THROWS_WITH_AS(KinematicTree({-1, 1}),
                         "kinematic tree: joint 1 does not hang from the root, expected no cycle", InvalidInput);
}
