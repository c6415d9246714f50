// SPDX-License-Identifier: MIT
/// @file
/// Columns of nine numbers turned into lanes and back, within registers.
///
/// What        columns_to_lanes(): 9 x n to n lanes of each of the nine; lanes_to_columns(): back
/// Equation    lanes[i][l] = columns[9 l + i]. A register of N lanes holds number N r + p of nine registers' worth of columns in
///             its lane p; 9 l + i = N r + p and the remainders by 9 and by N of both sides say how far lane p moves from
///             register to register (the same for all i) and then from lane to lane.
/// Shapes      columns: nine numbers each without gaps; float and double; fast where n is a multiple of the lanes of a register
/// Why         one number after the other costs a load and a store each: more than the arithmetic on a matrix
/// Width       natural_lanes of pack_mask.hpp; plain loops where that is one
/// Cost        45 operations on registers a way and N columns
/// Tests       tests/unit/linalg/nine_number_lanes_test.cpp
#pragma once

#include <softtissue/core/pack_mask.hpp>
#include <softtissue/core/scalar.hpp>

#include <cstddef>
#include <cstring>
#include <utility>

namespace softtissue {

namespace detail {

/// Nine registers of N lanes.
template <class S, std::size_t N>
class NineRegisters {
public:
    /// `stride` numbers from register to register in memory.
    void load(const S* from, std::size_t stride) {
        for (std::size_t i = 0; i < 9; ++i) {
            std::memcpy(&registers_[i], from + stride * i, sizeof(Register));
        }
    }
    void store(S* to, std::size_t stride) const {
        for (std::size_t i = 0; i < 9; ++i) {
            std::memcpy(to + stride * i, &registers_[i], sizeof(Register));
        }
    }

    void columns_to_lanes() {
        rotate<false>();
        sort<false>(std::make_index_sequence<9>());
    }
    void lanes_to_columns() {
        sort<true>(std::make_index_sequence<9>());
        rotate<true>();
    }

private:
    using Register = typename LaneStorage<S, int(N)>::Values;
    using Lanes = std::make_index_sequence<N>;

    /// 1 / N modulo 9
    static constexpr std::size_t inverse = [] {
        std::size_t result = 1;
        while (result * N % 9 != 1) {
            ++result;
        }
        return result;
    }();
    /// How many registers further the numbers of a lane come from.
    static constexpr std::size_t distance(std::size_t lane, bool back) {
        const std::size_t steps = inverse * lane % 9;
        return back ? steps : 8 * steps % 9;
    }

    template <bool back>
    void rotate() {
        step<back, 1>();
        step<back, 2>();
        step<back, 4>();
        step<back, 8>();
    }
    template <bool back, std::size_t bit>
    void step() {
        const NineRegisters from = *this;
        for (std::size_t r = 0; r < 9; ++r) {
            registers_[r] = blend<back, bit>(from.registers_[r], from.registers_[(r + bit) % 9], Lanes());
        }
    }
    template <bool back, std::size_t bit, std::size_t... lane>
    static Register blend(const Register& near, const Register& far, std::index_sequence<lane...>) {
        return __builtin_shufflevector(near, far, int((distance(lane, back) & bit) != 0 ? N + lane : lane)...);
    }

    /// After the rotation all numbers i are in register i / N modulo 9, that of column l in lane 9 l + i modulo N.
    template <bool back, std::size_t... i>
    void sort(std::index_sequence<i...>) {
        const NineRegisters from = *this;
        if constexpr (back) {
            ((registers_[inverse * i % 9] = permute<9, 9 * (16 - i)>(from.registers_[i], Lanes())), ...);
        } else {
            ((registers_[i] = permute<9, i>(from.registers_[inverse * i % 9], Lanes())), ...);
        }
    }
    template <std::size_t slope, std::size_t first, std::size_t... lane>
    static Register permute(const Register& from, std::index_sequence<lane...>) {
        return __builtin_shufflevector(from, from, int((slope * lane + first) % N)...);
    }

    Register registers_[9];
};

}  // namespace detail

/// lanes[i][l] = columns[9 l + i].
template <RealScalar S, std::size_t n>
void columns_to_lanes(const S* columns, S (&lanes)[9][n]) {
    constexpr std::size_t N = std::size_t(natural_lanes<S>);
    if constexpr (N > 1 && n % N == 0) {
        for (std::size_t l = 0; l < n; l += N) {
            detail::NineRegisters<S, N> registers;
            registers.load(columns + 9 * l, N);
            registers.columns_to_lanes();
            registers.store(lanes[0] + l, n);
        }
    } else {
        for (std::size_t l = 0; l < n; ++l) {
            for (std::size_t i = 0; i < 9; ++i) {
                lanes[i][l] = columns[9 * l + i];
            }
        }
    }
}

/// columns[9 l + i] = lanes[i][l].
template <RealScalar S, std::size_t n>
void lanes_to_columns(const S (&lanes)[9][n], S* columns) {
    constexpr std::size_t N = std::size_t(natural_lanes<S>);
    if constexpr (N > 1 && n % N == 0) {
        for (std::size_t l = 0; l < n; l += N) {
            detail::NineRegisters<S, N> registers;
            registers.load(lanes[0] + l, n);
            registers.lanes_to_columns();
            registers.store(columns + 9 * l, N);
        }
    } else {
        for (std::size_t l = 0; l < n; ++l) {
            for (std::size_t i = 0; i < 9; ++i) {
                columns[9 * l + i] = lanes[i][l];
            }
        }
    }
}

}  // namespace softtissue
