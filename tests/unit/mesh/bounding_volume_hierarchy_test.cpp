// SPDX-License-Identifier: MIT
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

using Items = std::vector<std::int32_t>;
using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Boxes in the unit cube on a lattice, so that many touch, coincide, or have no volume; some are large.
template <class S>
std::vector<Box<S>> lattice_boxes(Index count, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<Box<S>> boxes;
    for (Index i = 0; i < count; ++i) {
        const double largest = i % 50 == 0 ? 12 : 2.99;
        Vector3<S> lower;
        Vector3<S> sizes;
        for (int d = 0; d < 3; ++d) {
            lower(d) = S(random.index(16));
            sizes(d) = S(Index(random.uniform(0, largest)));
        }
        boxes.emplace_back(Vector3<S>(lower / S(16)), Vector3<S>((lower + sizes) / S(16)));
    }
    return boxes;
}

template <class S>
Vector3<S> lattice_point(RandomGenerator& random) {
    return Vector3<S>(S(random.index(33)), S(random.index(33)), S(random.index(33))) / S(32);
}

Items sorted(Items items) {
    std::sort(items.begin(), items.end());
    return items;
}

template <class S>
void check_queries(const BoundingVolumeHierarchy<S>& tree, const std::vector<Box<S>>& boxes) {
    RandomGenerator random(5);
    for (int query = 0; query < 200; ++query) {
        const Vector3<S> p = lattice_point<S>(random);
        const Vector3<S> q = lattice_point<S>(random);
        const Box<S> wanted(p.cwiseMin(q), p.cwiseMax(q));
        Items containing;
        Items overlapping;
        std::pair<S, std::int32_t> nearest(std::numeric_limits<S>::infinity(), -1);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const auto item = std::int32_t(i);
            if ((boxes[i].min().array() <= p.array()).all() && (p.array() <= boxes[i].max().array()).all()) {
                containing.push_back(item);
            }
            if ((boxes[i].min().array() <= wanted.max().array()).all() &&
                (wanted.min().array() <= boxes[i].max().array()).all()) {
                overlapping.push_back(item);
            }
            const S distance = (boxes[i].center() - p).squaredNorm();
            nearest = distance < nearest.first ? std::pair(distance, item) : nearest;
        }
        Items found;
        tree.for_each_containing(p, [&](std::int32_t item) { found.push_back(item); });
        CHECK(sorted(found) == containing);
        found.clear();
        tree.for_each_overlapping(wanted, [&](std::int32_t item) { found.push_back(item); });
        CHECK(sorted(found) == overlapping);
        const auto centre_distance = [&](std::int32_t item) {
            return (boxes[size_t(item)].center() - p).squaredNorm();
        };
        const auto result = tree.nearest(p, centre_distance);
        CHECK(result.item == nearest.second);
        CHECK(result.squared_distance == nearest.first);
    }
}

template <class S>
Pairs all_pairs(const std::vector<Box<S>>& first, const std::vector<Box<S>>& second, bool is_same) {
    Pairs pairs;
    for (std::size_t i = 0; i < first.size(); ++i) {
        for (std::size_t j = is_same ? i + 1 : 0; j < second.size(); ++j) {
            if (first[i].intersects(second[j])) {
                pairs.emplace_back(std::int32_t(i), std::int32_t(j));
            }
        }
    }
    return pairs;
}

}  // namespace

TEST_CASE_TEMPLATE("queries find what looking at all boxes finds", S, float, double) {
    for (const Index count : {0, 1, 4, 5, 9, 500}) {
        CAPTURE(count);
        const std::vector<Box<S>> boxes = lattice_boxes<S>(count, 1);
        BoundingVolumeHierarchy<S> tree(boxes);
        CHECK(tree.num_items() == count);
        check_queries(tree, boxes);

        const std::vector<Box<S>> moved = lattice_boxes<S>(count, 2);
        tree.refit(moved);
        check_queries(tree, moved);
    }
}

TEST_CASE_TEMPLATE("pairs are found once, within one tree and between two", S, float, double) {
    for (const Index count : {0, 1, 6, 400}) {
        CAPTURE(count);
        const std::vector<Box<S>> first = lattice_boxes<S>(count, 1);
        const std::vector<Box<S>> second = lattice_boxes<S>(150, 2);
        const BoundingVolumeHierarchy<S> tree(first);
        const BoundingVolumeHierarchy<S> other(second);
        Pairs found;
        const auto collect = [&found](std::int32_t i, std::int32_t j) { found.emplace_back(i, j); };
        tree.for_each_overlapping_pair(collect);
        std::sort(found.begin(), found.end());
        CHECK(found == all_pairs(first, first, true));
        found.clear();
        tree.for_each_overlapping_pair(other, collect);
        std::sort(found.begin(), found.end());
        CHECK(found == all_pairs(first, second, false));
    }
}

TEST_CASE("items that cannot be told apart are told apart by their numbers") {
    const std::vector<Box<double>> same(5000, Box<double>(Vector3<double>::Zero(), Vector3<double>::Ones()));
    const BoundingVolumeHierarchy<double> tree(same);
    Items found;
    tree.for_each_containing(Vector3<double>::Ones(), [&](std::int32_t item) { found.push_back(item); });
    CHECK(found.size() == same.size());
    CHECK(std::is_sorted(found.begin(), found.end()));
    CHECK(tree.nearest(Vector3<double>::Constant(7), [](std::int32_t) { return 108.0; }).item == 0);
}

TEST_CASE("every item is in one leaf, and every box in that of its parent") {
    const BoundingVolumeHierarchy<double> tree(lattice_boxes<double>(333, 3));
    Items items = tree.slot_items();
    CHECK(items.size() == 333);
    CHECK(std::unique(items.begin(), items.end()) == items.end());
    const auto& nodes = tree.nodes();
    CHECK(nodes.front().next == std::int32_t(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (nodes[k].is_leaf()) {
            CHECK(nodes[k].next == std::int32_t(k + 1));
            continue;
        }
        const auto& left = nodes[k + 1];
        const auto& right = nodes[size_t(left.next)];
        CHECK(left.begin == nodes[k].begin);
        CHECK(left.end == right.begin);
        CHECK(right.end == nodes[k].end);
        CHECK(right.next == nodes[k].next);
        CHECK(nodes[k].box.contains(left.box));
        CHECK(nodes[k].box.contains(right.box));
        CHECK(std::abs((left.end - left.begin) - (right.end - right.begin)) <= 1);
    }
}

TEST_CASE("nearest looks no farther than it is told") {
    const std::vector<Box<double>> boxes(9, Box<double>(Vector3<double>(1, 0, 0)));
    const BoundingVolumeHierarchy<double> tree(boxes);
    const auto squared_distance = [](std::int32_t item) { return item == 5 ? 1.0 : 4.0; };
    CHECK(tree.nearest(Vector3<double>::Zero(), squared_distance, 1.5).item == 5);
    CHECK(tree.nearest(Vector3<double>::Zero(), squared_distance, 1.0).item == tree.no_item);
    CHECK(BoundingVolumeHierarchy<double>({}).nearest(Vector3<double>::Zero(), squared_distance).item == tree.no_item);
}

TEST_CASE("a point that is not finite is in no box and has no nearest item") {
    const std::vector<Box<double>> boxes = lattice_boxes<double>(40, 4);
    const BoundingVolumeHierarchy<double> tree(boxes);
    const Vector3<double> p(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5);
    int visits = 0;
    tree.for_each_containing(p, [&](std::int32_t) { ++visits; });
    CHECK(visits == 0);
    const auto squared_distance = [&](std::int32_t item) { return (boxes[size_t(item)].center() - p).squaredNorm(); };
    CHECK(tree.nearest(p, squared_distance).item == tree.no_item);
}

TEST_CASE("boxes that are none are refused by number") {
    std::vector<Box<double>> boxes = lattice_boxes<double>(10, 5);
    BoundingVolumeHierarchy<double> tree(boxes);
    CHECK_THROWS_WITH_AS(tree.refit(lattice_boxes<double>(9, 5)), "hierarchy: 9 boxes, expected 10", InvalidInput);
    boxes[7].max()(1) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(tree.refit(boxes), "hierarchy: box 7 is empty or not finite", InvalidInput);
    boxes[7] = Box<double>();
    CHECK_THROWS_WITH_AS(BoundingVolumeHierarchy<double>{boxes}, "hierarchy: box 7 is empty or not finite",
                         InvalidInput);
}
