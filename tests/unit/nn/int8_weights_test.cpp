// SPDX-License-Identifier: MIT
#include <softtissue/nn/int8_weights.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/nn/concepts.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

static_assert(WeightPacking<Int8Weights>);

TEST_CASE("int8 weights are within half a step, tiny and huge ones included") {
    RandomGenerator random(1);
    for (const double size : {1e-45, 3e-44, 1e-38, 1.0, 3.4e38}) {
        for (int k = 0; k < 50; ++k) {
            std::vector<float> row(37);
            for (float& weight : row) {
                weight = float(size * random.uniform(-1, 1));
            }
            const float step = Int8Weights::step(row.data(), Index(row.size()));
            CHECK(step >= 0.0F);
            for (const float weight : row) {
                const std::uint32_t code = Int8Weights::code(weight, step);
                CHECK(code >= 1);
                CHECK(code <= 255);
                CHECK(std::abs(Int8Weights::value(code, step) - double(weight)) <= 0.5 * double(step));
            }
        }
    }
}

TEST_CASE("the largest int8 weight is kept to within rounding, a row of zeros is kept") {
    const std::vector<float> row{0.3F, -127.0F, 64.0F}, zeros(3, 0.0F);
    const float step = Int8Weights::step(row.data(), 3);
    CHECK(step == 1.0F);
    CHECK(Int8Weights::value(Int8Weights::code(row[1], step), step) == -127.0);
    CHECK(Int8Weights::step(zeros.data(), 3) == 0.0F);
    CHECK(Int8Weights::value(Int8Weights::code(0.0F, 0.0F), 0.0F) == 0.0);
    CHECK(Int8Weights::can_store(std::numeric_limits<float>::max()));
    CHECK(!Int8Weights::can_store(std::numeric_limits<float>::infinity()));
    CHECK(!Int8Weights::can_store(std::numeric_limits<float>::quiet_NaN()));
}
