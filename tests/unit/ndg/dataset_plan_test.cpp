// SPDX-License-Identifier: MIT
#include <softtissue/ndg/dataset_plan.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace softtissue;

TEST_CASE("the samples of a body are those that name it") {
    DatasetPlan plan;
    plan.bodies.resize(4);
    for (const std::int32_t body : {0, 0, 2, 2, 2, 3}) {
        plan.samples.push_back({DatasetSplit::train, body, 0});
    }
    CHECK(plan.num_samples() == 6);
    CHECK(plan.num_bodies() == 4);
    CHECK(plan.samples_of(0) == std::pair<Index, Index>(0, 2));
    CHECK(plan.samples_of(1) == std::pair<Index, Index>(2, 2));
    CHECK(plan.samples_of(2) == std::pair<Index, Index>(2, 5));
    CHECK(plan.samples_of(3) == std::pair<Index, Index>(5, 6));
}

TEST_CASE("every split has its own name") {
    std::set<std::string> names;
    for (const DatasetSplit split : all_dataset_splits) {
        names.insert(to_string(split));
    }
    CHECK(names.size() == all_dataset_splits.size());
    CHECK(names.count("unknown") == 0);
}
