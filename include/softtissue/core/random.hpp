// SPDX-License-Identifier: MIT
/// @file
/// Reproducible random numbers: the same bits on every platform.
///
/// What        RandomGenerator: bits, uniform and normal numbers, indices, shuffles
/// Source      Blackman, Vigna 2021, "Scrambled Linear Pseudorandom Number Generators" (xoshiro256++);
///             seeding by splitmix64
/// Departs     normal() is a sum of twelve uniform numbers: no library function, hence the same bits everywhere;
///             consequence: its tails end at +-6
/// Tests       tests/unit/core/random_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace softtissue {

/// xoshiro256++; equal seeds give equal sequences.
class RandomGenerator {
public:
    explicit RandomGenerator(std::uint64_t seed) {
        for (std::uint64_t& word : state_) {
            seed += 0x9e3779b97f4a7c15U;
            word = (seed ^ (seed >> 30U)) * 0xbf58476d1ce4e5b9U;
            word = (word ^ (word >> 27U)) * 0x94d049bb133111ebU;
            word ^= word >> 31U;
        }
    }

    /// 64 uniform bits.
    std::uint64_t bits() {
        const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t shifted = state_[1] << 17U;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = std::rotl(state_[3], 45);
        return result;
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return double(bits() >> 11U) * 0x1p-53; }

    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Mean 0, variance 1, |x| <= 6.
    double normal() {
        double sum = -6;
        for (int i = 0; i < 12; ++i) {
            sum += uniform();
        }
        return sum;
    }

    /// Uniform in 0 .. count - 1 (count > 0).
    Index index(Index count) { return Index(uniform() * double(count)); }

    /// Puts the values in one of all their orders, each equally likely (Fisher, Yates).
    template <class T>
    void shuffle(std::span<T> values) {
        for (size_t i = values.size(); i > 1; --i) {
            std::swap(values[i - 1], values[size_t(index(Index(i)))]);
        }
    }

private:
    std::array<std::uint64_t, 4> state_{};
};

}  // namespace softtissue
