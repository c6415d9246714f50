// SPDX-License-Identifier: MIT
#include <softtissue/nn/int4_weights.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/nn/concepts.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

static_assert(WeightPacking<Int4Weights>);

TEST_CASE("int4 weights are within half a step, tiny and huge ones included") {
    RandomGenerator random(1);
    for (const double size : {1e-45, 3e-44, 1e-38, 1.0, 3.4e38}) {
        for (int k = 0; k < 50; ++k) {
            const double low = random.uniform(-1, 0.5), high = random.uniform(-0.5, 1);
            std::vector<float> row(37);
            for (float& weight : row) {
                weight = float(size * random.uniform(low, high));
            }
            const float step = Int4Weights::step(row.data(), Index(row.size()));
            for (const float weight : row) {
                const std::uint32_t code = Int4Weights::code(weight, step);
                CHECK(code <= 15);
                CHECK(std::abs(Int4Weights::value(code, step) - double(weight)) <= 0.5 * std::abs(double(step)));
            }
        }
    }
}

TEST_CASE("the longer side of a row has eight steps") {
    const std::vector<float> down{7.0F, -8.0F, 1.0F}, up{8.0F, -3.0F, 1.0F}, even{8.0F, -8.0F, 0.0F}, zeros(3, 0.0F);
    CHECK(Int4Weights::step(down.data(), 3) == 1.0F);
    CHECK(Int4Weights::step(up.data(), 3) == -1.0F);
    CHECK(Int4Weights::value(Int4Weights::code(8.0F, -1.0F), -1.0F) == 8.0);
    CHECK(Int4Weights::step(even.data(), 3) == doctest::Approx(8.0 / 7));
    CHECK(Int4Weights::step(zeros.data(), 3) == 0.0F);
    CHECK(Int4Weights::value(Int4Weights::code(0.0F, 0.0F), 0.0F) == 0.0);
    CHECK(!Int4Weights::can_store(-std::numeric_limits<float>::infinity()));
}
