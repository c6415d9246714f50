// SPDX-License-Identifier: MIT
#include <softtissue/nn/weight_format.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace softtissue;

TEST_CASE("formats of weights have the names of the enumeration") {
    std::string names;
    for (const WeightFormat format : all_weight_formats) {
        names += std::string(to_string(format)) + " ";
    }
    CHECK(names == "full bfloat16 int8 int4 ");
    CHECK(std::string(to_string(WeightFormat(7))) == "unknown");
}
