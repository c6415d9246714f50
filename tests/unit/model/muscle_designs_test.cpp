// SPDX-License-Identifier: MIT
#include <softtissue/model/muscle_designs.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace softtissue;

TEST_CASE("the designs are complete and keep to their meaning") {
    std::set<std::string> names;
    std::set<MuscleDesign::Region> regions;
    for (const MuscleDesign& design : muscle_designs()) {
        CAPTURE(design.name);
        CHECK(names.insert(design.name).second);
        regions.insert(design.region);
        CHECK(design.inner >= 0);
        CHECK(design.inner < design.outer);
        CHECK(design.outer < 1);  // just inside the muscle wrap
        CHECK(design.sinking >= 0);
        CHECK(design.sinking <= 1);
        CHECK(design.stations.size() >= 4);
        for (const MuscleDesign::Station& s : design.stations) {
            CHECK(s(0) > -0.3);
            CHECK(s(0) < 1.2);
            CHECK(s.tail<2>().minCoeff() >= 0);
            CHECK(s.tail<2>().maxCoeff() > 0);
            CHECK(s(3) <= 90);
        }
    }
    CHECK(regions.size() == 5);
}
