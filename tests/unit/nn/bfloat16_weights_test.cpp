// SPDX-License-Identifier: MIT
#include <softtissue/nn/bfloat16_weights.hpp>

#include <softtissue/core/float16.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/nn/concepts.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

static_assert(WeightPacking<BFloat16Weights>);
static_assert(!WeightPacking<FloatColumns>);

TEST_CASE("bfloat16 weights are the nearest numbers") {
    RandomGenerator random(1);
    const auto check = [](float weight) {
        const std::uint32_t code = BFloat16Weights::code(weight, 1.0F);
        CHECK(code == BFloat16::nearest(double(weight)).bits);
        CHECK(BFloat16Weights::value(code, 1.0F) == BFloat16::nearest(double(weight)).value());
        CHECK(std::abs(BFloat16Weights::value(code, 1.0F) - double(weight)) <=
              std::max(std::abs(double(weight)) / 256, 0x1p-134));
    };
    for (int k = 0; k < 2000; ++k) {
        check(std::ldexp(float(random.uniform(-1, 1)), static_cast<int>(random.index(250)) - 140));
    }
    for (const float weight : {0.0F, -0.0F, 1.00390625F, 1.01171875F, 3.38e38F, 1e-45F}) {  // ties to even among them
        check(weight);
    }
}

TEST_CASE("what is not finite, or rounds to infinity, cannot be stored") {
    using Limits = std::numeric_limits<float>;
    CHECK(BFloat16Weights::can_store(3.38e38F));
    CHECK(!BFloat16Weights::can_store(Limits::max()));
    CHECK(!BFloat16Weights::can_store(Limits::infinity()));
    CHECK(!BFloat16Weights::can_store(Limits::quiet_NaN()));
}
