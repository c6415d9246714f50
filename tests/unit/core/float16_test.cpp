// SPDX-License-Identifier: MIT
#include <softtissue/core/float16.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace softtissue;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class F>
F from_bits(int bits) {
    return {static_cast<std::uint16_t>(bits)};
}

}  // namespace

TEST_CASE("known numbers of binary16") {
    CHECK(from_bits<Half>(0x3C00).value() == 1.0);
    CHECK(from_bits<Half>(0xC000).value() == -2.0);
    CHECK(from_bits<Half>(0x7BFF).value() == 65504.0);
    CHECK(from_bits<Half>(0x0400).value() == 0x1p-14);
    CHECK(from_bits<Half>(0x0001).value() == 0x1p-24);
    CHECK(from_bits<Half>(0x3555).value() == 0.333251953125);
    CHECK(from_bits<Half>(0x7C00).value() == infinity);
    CHECK(from_bits<Half>(0xFC00).value() == -infinity);
    CHECK(std::isnan(from_bits<Half>(0x7E00).value()));
    CHECK(std::signbit(from_bits<Half>(0x8000).value()));
}

TEST_CASE("bfloat16 is the upper half of a float") {
    for (int bits = 0; bits <= 0xFFFF; ++bits) {
        const double expected = double(std::bit_cast<float>(static_cast<std::uint32_t>(bits) << 16));
        const double value = from_bits<BFloat16>(bits).value();
        if (!(std::isnan(expected) ? std::isnan(value) : value == expected)) {
            CHECK_MESSAGE(false, "bits " << bits);
        }
    }
}

TEST_CASE_TEMPLATE("every number is its own nearest", F, Half, BFloat16) {
    for (int bits = 0; bits <= 0xFFFF; ++bits) {
        const F number = from_bits<F>(bits);
        const F again = F::nearest(number.value());
        if (!(std::isnan(number.value()) ? std::isnan(again.value()) : again.bits == number.bits)) {
            CHECK_MESSAGE(false, "bits " << bits);
        }
    }
}

TEST_CASE_TEMPLATE("between two neighbours the nearer one is taken, half way the even one", F, Half, BFloat16) {
    for (int bits = 0; bits + 1 < F::infinity; ++bits) {
        const double low = from_bits<F>(bits).value();
        const double high = from_bits<F>(bits + 1).value();
        const double middle = 0.5 * (low + high);
        const double step = high - low;
        const bool is_right =
            F::nearest(middle - 0.25 * step).bits == bits && F::nearest(middle + 0.25 * step).bits == bits + 1 &&
            F::nearest(middle).bits == bits + bits % 2 && F::nearest(-middle).bits == (0x8000 | (bits + bits % 2));
        if (!is_right) {
            CHECK_MESSAGE(false, "bits " << bits);
        }
    }
}

TEST_CASE("what is too large becomes infinite, half a step above the largest number") {
    CHECK(Half::nearest(65519.99).value() == 65504.0);
    CHECK(Half::nearest(65520.0).value() == infinity);
    CHECK(Half::nearest(-1e300).value() == -infinity);
    CHECK(Half::nearest(infinity).bits == 0x7C00);
    CHECK(BFloat16::nearest(1e39).value() == infinity);
    CHECK(Half::nearest(0x1p-26).bits == 0);
    CHECK(Half::nearest(std::numeric_limits<double>::denorm_min()).bits == 0);
}
