// SPDX-License-Identifier: MIT
#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>

using namespace softtissue;

TEST_CASE("the sequence is xoshiro256++ seeded by splitmix64, on every platform") {
    // splitmix64 from seed 0 begins e220a8397b1dcdaf 6e789e6aa1b965f4 06c45d188009454f f88bb8a8724c81ec (published
    // reference output); the first output is rotl(s0 + s3, 23) + s0 of these words.
    RandomGenerator random(0);
    CHECK(random.bits() == std::rotl(0xe220a8397b1dcdafU + 0xf88bb8a8724c81ecU, 23) + 0xe220a8397b1dcdafU);
    RandomGenerator same(0);
    RandomGenerator other(1);
    const std::uint64_t first = same.bits();
    CHECK(first != other.bits());
    CHECK(same.bits() == random.bits());
}

TEST_CASE("uniform and normal numbers have their moments") {
    constexpr int count = 40000;
    RandomGenerator random(7);
    double mean = 0, square = 0, normal_mean = 0, normal_square = 0, normal_fourth = 0;
    for (int i = 0; i < count; ++i) {
        const double u = random.uniform();
        CHECK_UNARY(u >= 0);
        CHECK_UNARY(u < 1);
        mean += u / count;
        square += u * u / count;
        const double x = random.normal();
        normal_mean += x / count;
        normal_square += x * x / count;
        normal_fourth += x * x * x * x / count;
    }
    // Five standard errors: sigma / sqrt(count) with sigma of u, u^2, x, x^2, x^4.
    const double five_errors = 5 / std::sqrt(double(count));
    CHECK(std::abs(mean - 1.0 / 2) < five_errors * 0.289);
    CHECK(std::abs(square - 1.0 / 3) < five_errors * 0.298);
    CHECK(std::abs(normal_mean) < five_errors);
    CHECK(std::abs(normal_square - 1) < five_errors * 1.42);
    CHECK(std::abs(normal_fourth - 2.9) < five_errors * 9);  // 3 - 6/5 / 12: a sum of twelve
}

TEST_CASE("index() reaches every value and no other") {
    RandomGenerator random(2);
    std::set<Index> seen;
    for (int i = 0; i < 200; ++i) {
        seen.insert(random.index(5));
    }
    CHECK(seen == std::set<Index>{0, 1, 2, 3, 4});
}

TEST_CASE("shuffle() reaches every order equally often") {
    constexpr int count = 6000;
    RandomGenerator random(3);
    std::map<std::array<int, 3>, int> seen;
    for (int i = 0; i < count; ++i) {
        std::array<int, 3> values = {0, 1, 2};
        random.shuffle(std::span<int>(values));
        ++seen[values];
    }
    CHECK(seen.size() == 6);
    for (const auto& [order, times] : seen) {
        CHECK(std::abs(times - count / 6.0) < 5 * std::sqrt(count / 6.0));  // five standard errors
    }
}
