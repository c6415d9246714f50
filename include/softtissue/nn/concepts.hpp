// SPDX-License-Identifier: MIT
/// @file
/// What an activation of a network offers, and a way to keep weights in few bytes.
///
/// What        Activation: a stateless function of one number, given with its derivative
///             WeightPacking: how numbers become codes of 32 / block_inputs bits, and how words of codes are multiplied
/// Laws        slope is the derivative of value (Taylor rate); at() has no branch that keeps a loop from vectorising.
///             |value(code(w, s), s) - w| <= |s| / 2 for the weights of a row and s = step(row) (has_steps), or a rounding
///             of w; the codes of a block's inputs, shifted by shift(input), do not overlap in a word; total() is the sum
///             of value / step times the columns' numbers.
/// Tests       tests/unit/nn/concepts_test.cpp
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace softtissue {

/// An activation and its derivative at one point.
template <class S>
struct ActivationValue {
    S value;
    S slope;
};

template <class A>
concept Activation = std::is_empty_v<A> && requires(float x, double y) {
    { A::at(x) } -> std::same_as<ActivationValue<float>>;
    { A::at(y) } -> std::same_as<ActivationValue<double>>;
};

/// A row of weights to codes in words, and sums of their products with the columns of a batch.
template <class W>
concept WeightPacking = std::is_empty_v<W> &&
    requires(const float* weights, float weight, std::uint32_t code, typename W::Columns columns, typename W::Sums sums,
             const typename W::Block& block, const typename W::Columns::Element* column) {
    { W::block_inputs + W::block_elements } -> std::convertible_to<long>;
    { W::has_steps } -> std::convertible_to<bool>;
    { W::shift(0) } -> std::same_as<int>;
    { W::can_store(weight) } -> std::same_as<bool>;
    { W::step(weights, 1) } -> std::same_as<float>;
    { W::code(weight, weight) } -> std::same_as<std::uint32_t>;
    { W::value(code, weight) } -> std::same_as<double>;
    sums.add(block, column);
    sums.total(columns, 0);
};

}  // namespace softtissue
