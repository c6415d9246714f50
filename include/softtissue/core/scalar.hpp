// SPDX-License-Identifier: MIT
/// @file
/// What a scalar is: `RealScalar` (float, double) and `FieldScalar` (also numbers that carry derivatives).
///
/// What        concepts, the real type underneath a scalar, and its plain value for branching.
/// Extend      a number type of your own specialises ScalarTraits: `Real` and `static Real value(x)`.
/// Tests       tests/unit/core/scalar_test.cpp
#pragma once

#include <concepts>

namespace softtissue {

/// How a scalar relates to a plain floating-point number. Specialised by Dual.
template <class Scalar>
struct ScalarTraits {};

template <std::floating_point T>
struct ScalarTraits<T> {
    using Real = T;
    static constexpr Real value(T x) { return x; }
};

/// float, double or long double.
template <class T>
concept RealScalar = std::floating_point<T>;

/// A number that materials, elements and skinning can be evaluated with: real, or carrying derivatives.
template <class T>
concept FieldScalar = requires(const T& a, const T& b) {
    typename ScalarTraits<T>::Real;
    { ScalarTraits<T>::value(a) } -> std::same_as<typename ScalarTraits<T>::Real>;
    T(a + b);
    T(a - b);
    T(a * b);
    T(a / b);
    T(-a);
};

/// The floating-point type underneath a scalar; tolerances and options have this type.
template <FieldScalar Scalar>
using RealOf = typename ScalarTraits<Scalar>::Real;

/// The plain value of a scalar, for branching.
template <FieldScalar Scalar>
constexpr RealOf<Scalar> value_of(const Scalar& x) {
    return ScalarTraits<Scalar>::value(x);
}

}  // namespace softtissue
