// SPDX-License-Identifier: MIT
#include <softtissue/sparse/supernodes.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <span>

using namespace softtissue;

namespace {

using Rows = std::set<std::int32_t>;

/// By eliminating vertex after vertex: which vertices each one still has as neighbours when its turn comes.
std::vector<Rows> eliminate(const BlockPattern& graph, const std::vector<std::int32_t>& order) {
    std::vector<Rows> left(order.size());
    for (Index v = 0; v < graph.num_columns(); ++v) {
        left[size_t(v)].insert(graph.rows(v).begin(), graph.rows(v).end());
        left[size_t(v)].erase(std::int32_t(v));
    }
    for (const std::int32_t v : order) {
        for (const std::int32_t a : left[size_t(v)]) {
            left[size_t(a)].erase(v);
            for (const std::int32_t b : left[size_t(v)]) {
                if (a != b) {
                    left[size_t(a)].insert(b);
                }
            }
        }
    }
    return left;
}

BlockPattern random_graph(std::int32_t n, int edges, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<std::vector<std::int32_t>> neighbours(static_cast<size_t>(n));
    for (int k = 0; k < edges; ++k) {
        const auto a = std::int32_t(random.index(n));
        const auto b = std::int32_t(random.index(n));
        neighbours[size_t(a)].push_back(b);
        neighbours[size_t(b)].push_back(a);
    }
    return BlockPattern(neighbours);
}

void check(const BlockPattern& graph, const std::vector<std::int32_t>& order,
           const std::vector<std::int32_t>& weights) {
    const std::vector<Supernode> supernodes = make_supernodes(graph, order, weights);
    std::vector<std::int32_t> new_order;
    std::vector<std::int32_t> place(order.size(), -1), supernode_of(order.size(), -1);
    for (size_t s = 0; s < supernodes.size(); ++s) {
        REQUIRE_FALSE(supernodes[s].columns.empty());
        for (const std::int32_t v : supernodes[s].columns) {
            REQUIRE(place[size_t(v)] == -1);
            place[size_t(v)] = std::int32_t(new_order.size());
            supernode_of[size_t(v)] = std::int32_t(s);
            new_order.push_back(v);
        }
    }
    REQUIRE(new_order.size() == order.size());
    const std::vector<Rows> exact = eliminate(graph, new_order);
    size_t exact_fill = 0;
    for (const Rows& rows : eliminate(graph, order)) {
        exact_fill += rows.size();
    }
    size_t new_fill = 0;
    for (size_t s = 0; s < supernodes.size(); ++s) {
        const Supernode& supernode = supernodes[s];
        Rows stored(supernode.rows.begin(), supernode.rows.end());
        for (size_t k = 1; k < supernode.rows.size(); ++k) {
            CHECK(place[size_t(supernode.rows[k - 1])] < place[size_t(supernode.rows[k])]);
        }
        if (supernode.rows.empty()) {
            CHECK(supernode.parent == Supernode::no_parent);
        } else {
            CHECK(supernode.parent == supernode_of[size_t(supernode.rows.front())]);
            CHECK(supernode.parent > std::int32_t(s));
        }
        // every row of the factor is stored; rows of the last column are exact
        for (size_t k = supernode.columns.size(); k-- > 0;) {
            const std::int32_t column = supernode.columns[k];
            const Rows& rows = exact[size_t(column)];
            new_fill += rows.size();
            CHECK(std::includes(stored.begin(), stored.end(), rows.begin(), rows.end()));
            if (k + 1 == supernode.columns.size()) {
                CHECK(stored == rows);
            }
            stored.insert(column);
        }
    }
    CHECK(new_fill == exact_fill);
}

std::vector<std::int32_t> identity_order(size_t n) {
    std::vector<std::int32_t> order(n);
    std::iota(order.begin(), order.end(), 0);
    return order;
}

}  // namespace

TEST_CASE("the rows of the factor of random graphs are stored, its fill is kept") {
    for (const int edges : {0, 10, 40, 120}) {
        for (const std::uint64_t seed : {1u, 2u, 3u}) {
            CAPTURE(edges);
            CAPTURE(seed);
            const BlockPattern graph = random_graph(40, edges, seed);
            std::vector<std::int32_t> order = identity_order(40), weights(40);
            RandomGenerator random(seed);
            random.shuffle(std::span(order));
            for (size_t v = 0; v < 40; ++v) {
                weights[v] = std::int32_t(1 + random.index(29));
            }
            check(graph, order, weights);
        }
    }
}

TEST_CASE("a complete graph is one supernode, isolated vertices are one each") {
    const std::vector<std::int32_t> ones(5, 1);
    CHECK(make_supernodes(BlockPattern({{0, 1, 2, 3, 4}, {0, 2, 3, 4}, {0, 1, 3, 4}, {0, 1, 2, 4}, {0, 1, 2, 3}}),
                          identity_order(5), ones)
              .size() == 1);
    CHECK(make_supernodes(BlockPattern({{}, {}, {}, {}, {}}), identity_order(5), ones).size() == 5);
    CHECK(make_supernodes(BlockPattern(), {}, {}).empty());
}

TEST_CASE("small supernodes are merged, wide ones only where few zeros are stored") {
    // a path has two entries per column
    std::vector<std::vector<std::int32_t>> path(40);
    for (std::int32_t v = 1; v < 40; ++v) {
        path[size_t(v)].push_back(v - 1);
        path[size_t(v - 1)].push_back(v);
    }
    const std::vector<std::int32_t> light(40, 1), heavy(40, 100);
    CHECK(make_supernodes(BlockPattern(path), identity_order(40), light).size() < 20);
    CHECK(make_supernodes(BlockPattern(path), identity_order(40), heavy).size() == 39);
}
