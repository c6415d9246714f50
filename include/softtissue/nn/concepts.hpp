// SPDX-License-Identifier: MIT
/// @file
/// What an activation of a network offers.
///
/// What        Activation: a stateless function of one number, given with its derivative
/// Laws        slope is the derivative of value (Taylor rate); at() has no branch that keeps a loop from vectorising
/// Tests       tests/unit/nn/concepts_test.cpp
#pragma once

#include <concepts>
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

}  // namespace softtissue
