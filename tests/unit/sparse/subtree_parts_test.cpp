// SPDX-License-Identifier: MIT
#include <softtissue/sparse/subtree_parts.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace softtissue;

namespace {

using Parents = std::vector<std::int32_t>;

double cost(const std::vector<std::int32_t>& parts, const std::vector<double>& work, int num_parts) {
    std::vector<double> loads(size_t(num_parts) + 1, 0.0);
    for (size_t k = 0; k < parts.size(); ++k) {
        loads[size_t(parts[k])] += work[k];
    }
    return loads.back() + *std::max_element(loads.begin(), loads.end() - 1);
}

}  // namespace

TEST_CASE("two equal trees under a root: one for each part, the root is the top") {
    const Parents parents{2, 2, 6, 5, 5, 6, -1};
    const std::vector<double> work(7, 1.0);
    CHECK(make_subtree_parts(parents, work, 2) == Parents{0, 0, 0, 1, 1, 1, 2});
}

TEST_CASE("a chain is all top, and so is nothing") {
    CHECK(make_subtree_parts(Parents{1, 2, 3, -1}, std::vector<double>{1, 2, 3, 4}, 2) == Parents{2, 2, 2, 2});
    CHECK(make_subtree_parts(Parents{}, std::vector<double>{}, 3).empty());
    CHECK(make_subtree_parts(Parents{-1}, std::vector<double>{0.0}, 1) == Parents{1});
}

TEST_CASE("a heavy root beside light trees: splitting it would gain nothing") {
    const Parents parents{-1, -1, -1};
    CHECK(make_subtree_parts(parents, std::vector<double>{1, 5, 4}, 2) == Parents{1, 0, 1});
}

TEST_CASE("random forests: whole subtrees, and never slower than one thread") {
    RandomGenerator random(4);
    for (int repeat = 0; repeat < 50; ++repeat) {
        const int n = 1 + int(random.uniform() * 300);
        Parents parents(static_cast<size_t>(n));
        std::vector<double> work(static_cast<size_t>(n));
        double total = 0;
        for (int k = 0; k < n; ++k) {
            const int up = 1 + int(random.uniform() * (repeat % 2 == 0 ? 6 : 60));
            parents[size_t(k)] = k + up < n ? k + up : -1;
            work[size_t(k)] = random.uniform();
            total += work[size_t(k)];
        }
        const int num_parts = 1 + repeat % 4;
        const std::vector<std::int32_t> parts = make_subtree_parts(parents, work, num_parts);
        REQUIRE(parts.size() == size_t(n));
        for (size_t k = 0; k < size_t(n); ++k) {
            const std::int32_t above = parents[k] < 0 ? num_parts : parts[size_t(parents[k])];
            CHECK(parts[k] >= 0);
            CHECK(parts[k] <= num_parts);
            CHECK((above == parts[k] || above == num_parts));
        }
        CHECK(cost(parts, work, num_parts) <= total * (1 + 1e-12));
    }
}
