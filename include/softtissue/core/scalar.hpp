// SPDX-License-Identifier: MIT
/// @file
/// What a scalar is: `RealScalar` (float, double), `RealLanes` (also several side by side), `FieldScalar` (also numbers
/// that carry derivatives).
///
/// What        concepts, the real type underneath a scalar, its plain value for branching; masks of plain scalars
/// Branching   a formula without branches, written with select(), any_of() and all_of(), serves scalars and packs alike: what
///             a comparison of two scalars gives is a mask, for float and double a bool.
/// Extend      a number type of your own specialises ScalarTraits: `Real` and `static Real value(x)`.
/// Tests       tests/unit/core/scalar_test.cpp
#pragma once

#include <concepts>
#include <type_traits>

namespace softtissue {

/// How a scalar relates to a plain floating-point number. Specialised by Dual and Pack.
template <class Scalar>
struct ScalarTraits {};

template <std::floating_point T>
struct ScalarTraits<T> {
    using Real = T;
    static constexpr int num_lanes = 1;
    static constexpr Real value(T x) { return x; }
};

/// float, double or long double.
template <class T>
concept RealScalar = std::floating_point<T>;

/// A number that materials, elements and skinning can be evaluated with: real, several side by side, or carrying derivatives.
template <class T>
concept FieldScalar = requires(const T& a, const T& b) {
    typename ScalarTraits<T>::Real;
    T(a + b);
    T(a - b);
    T(a * b);
    T(a / b);
    T(-a);
};

/// A number with one plain value to branch on; a pack has none.
template <class T>
concept HasPlainValue = FieldScalar<T> && requires(const T& a) {
    { ScalarTraits<T>::value(a) } -> std::same_as<typename ScalarTraits<T>::Real>;
};

/// Real numbers without derivatives: one (float, double) or several side by side (Pack).
template <class T>
concept RealLanes = FieldScalar<T> && requires {
    { ScalarTraits<T>::num_lanes } -> std::convertible_to<int>;
};

/// What may be mixed with a Dual or a Pack.
template <class T>
concept PlainNumber = std::is_arithmetic_v<T>;

/// The floating-point type underneath a scalar; tolerances and options have this type.
template <FieldScalar Scalar>
using RealOf = typename ScalarTraits<Scalar>::Real;

/// How many numbers stand side by side in a scalar.
template <RealLanes T>
inline constexpr int num_lanes = ScalarTraits<T>::num_lanes;

/// The plain value of a scalar, for branching.
template <HasPlainValue Scalar>
constexpr RealOf<Scalar> value_of(const Scalar& x) {
    return ScalarTraits<Scalar>::value(x);
}

/// `mask ? a : b`; lane by lane for packs.
template <class T>
constexpr T select(bool mask, const T& a, const T& b) {
    return mask ? a : b;
}

/// Whether a mask holds in any lane.
constexpr bool any_of(bool mask) {
    return mask;
}

/// Whether a mask holds in all lanes.
constexpr bool all_of(bool mask) {
    return mask;
}

}  // namespace softtissue
