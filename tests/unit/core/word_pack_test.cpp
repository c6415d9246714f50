// SPDX-License-Identifier: MIT
#include <softtissue/core/word_pack.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <array>
#include <bit>

using namespace softtissue;

namespace {

constexpr int lanes = WordPack::lanes;

/// Any words, and those whose bytes are extreme.
std::array<std::uint32_t, size_t(lanes)> words(RandomGenerator& random) {
    std::array<std::uint32_t, size_t(lanes)> result;
    for (std::uint32_t& word : result) {
        word = static_cast<std::uint32_t>(random.bits());
        word |= random.index(3) == 0 ? 0xff00ff00U : 0U;
        word &= random.index(3) == 0 ? 0x00ffff00U : 0xffffffffU;
    }
    return result;
}

std::int32_t signed_word(std::uint32_t word) {
    return static_cast<std::int32_t>(word);
}

}  // namespace

TEST_CASE("words are masked and shifted, and read as floats or integers") {
    RandomGenerator random(1);
    const auto from = words(random);
    const WordPack pack = WordPack::load(from.data());
    std::array<float, size_t(lanes)> floats, numbers;
    pack.masked(0x7f00ff00U).shifted_right(8).to_floats().store(numbers.data());
    pack.masked(0x0000ffffU).shifted_left(14).as_floats().store(floats.data());
    const WordPack difference = pack - WordPack::all(5);
    std::array<std::uint32_t, size_t(lanes)> differences;
    std::memcpy(differences.data(), &difference.words, sizeof differences);
    for (size_t l = 0; l < size_t(lanes); ++l) {
        CHECK(numbers[l] == float((from[l] & 0x7f00ff00U) >> 8));
        CHECK(std::bit_cast<std::uint32_t>(floats[l]) == (from[l] & 0xffffU) << 14);
        CHECK(differences[l] == from[l] - 5U);
    }
}

TEST_CASE("products of unsigned and signed bytes are exact, extremes included") {
    RandomGenerator random(2);
    std::array<std::int64_t, size_t(lanes)> expected{};
    WordPack sums = WordPack::all(0);
    for (int k = 0; k < 2000; ++k) {
        const auto u = words(random);
        const std::uint32_t s = k % 5 == 0 ? 0x80808080U : k % 7 == 0 ? 0x7f7f7f7fU : words(random)[0];
        sums.add_byte_products(WordPack::load(u.data()), signed_word(s));
        for (size_t l = 0; l < size_t(lanes); ++l) {
            for (int bit = 0; bit < 32; bit += 8) {
                expected[l] += std::int64_t(u[l] >> bit & 255U) * static_cast<std::int8_t>(s >> bit & 255U);
            }
        }
    }
    std::array<std::int32_t, size_t(lanes)> actual;
    std::memcpy(actual.data(), &sums.words, sizeof actual);
    for (size_t l = 0; l < size_t(lanes); ++l) {
        CHECK(actual[l] == expected[l]);
    }
}

TEST_CASE("plain arithmetic gives the same products") {
    RandomGenerator random(3);
    for (int k = 0; k < 100; ++k) {
        const auto u = words(random);
        const std::int32_t s = signed_word(words(random)[0]);
        WordPack sums = WordPack::all(0);
        sums.add_byte_products(WordPack::load(u.data()), s);
        CHECK(detail::plain_byte_products(signed_word(u[0]), s) ==
              std::bit_cast<std::array<std::int32_t, size_t(lanes)>>(sums.words)[0]);
    }
}

TEST_CASE("65,536 of the largest products stay within a word") {
    WordPack sums = WordPack::all(0);
    for (int k = 0; k < 65536 / 4; ++k) {
        sums.add_byte_products(WordPack::all(-1), signed_word(0x80808080U));
    }
    CHECK(std::bit_cast<std::array<std::int32_t, size_t(lanes)>>(sums.words)[0] == -255 * 128 * 65536);
}
