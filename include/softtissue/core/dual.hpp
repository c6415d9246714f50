// SPDX-License-Identifier: MIT
/// @file
/// Forward-mode dual number: a value with its derivatives by N variables, exact to round-off.
///
/// What        arithmetic, comparisons and elementary functions on Dual<T, N>; usable as an Eigen scalar
/// Equation    f(v + d e) = f(v) + f'(v) d e,  e^2 = 0;  one e per variable
/// Nesting     Dual<Dual<double, 9>, 9> carries second derivatives: x.derivative[i].derivative[j]
/// Branching   comparisons look at the values alone: a branch is differentiated as the piece it takes
/// Valid       wherever f is differentiable; sqrt, pow and log at their singular points give inf or NaN
/// Cost        a product is 1 + 2 N products of T, an elementary function one call and N products
/// Tests       tests/unit/core/dual_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace softtissue {

/// A value and its N first derivatives; T is a real number or another Dual.
template <class T, int N>
struct Dual {
    using Real = typename ScalarTraits<T>::Real;

    T value;
    std::array<T, std::size_t(N)> derivative;

    /// Uninitialised like a plain number: zeros that every operation overwrites would cost as much as the operation.
    Dual() = default;

    /// A constant; implicit, so that `S x = 1` and `2 * F` read as for a plain number.
    template <PlainNumber A>
    constexpr Dual(A constant) : value(static_cast<Real>(constant)), derivative{} {}

    /// A constant of the inner level of a nested dual.
    constexpr Dual(const T& constant) requires(!PlainNumber<T>) : value(constant), derivative{} {}

    constexpr Dual(const T& v, const std::array<T, std::size_t(N)>& d) : value(v), derivative(d) {}

    /// The i-th independent variable: derivative 1 by itself, 0 by all others.
    static constexpr Dual variable(const T& value, int i) {
        Dual x{};
        x.value = value;
        x.derivative[std::size_t(i)] = T(Real(1));
        return x;
    }

    constexpr Dual& operator+=(const Dual& b) { return *this = *this + b; }
    constexpr Dual& operator-=(const Dual& b) { return *this = *this - b; }
    constexpr Dual& operator*=(const Dual& b) { return *this = *this * b; }
    constexpr Dual& operator/=(const Dual& b) { return *this = *this / b; }

    friend constexpr Dual operator+(const Dual& a) { return a; }
    friend constexpr Dual operator-(const Dual& a) {
        return combined(-a.value, a, [](const T& da) { return T(-da); });
    }

    friend constexpr Dual operator+(const Dual& a, const Dual& b) {
        return combined(a.value + b.value, a, b, [](const T& da, const T& db) { return T(da + db); });
    }
    friend constexpr Dual operator-(const Dual& a, const Dual& b) {
        return combined(a.value - b.value, a, b, [](const T& da, const T& db) { return T(da - db); });
    }
    friend constexpr Dual operator*(const Dual& a, const Dual& b) {
        return combined(a.value * b.value, a, b,
                        [&](const T& da, const T& db) { return T(da * b.value + a.value * db); });
    }
    friend constexpr Dual operator/(const Dual& a, const Dual& b) {
        const T inverse = T(Real(1)) / b.value;
        const T quotient = a.value * inverse;
        return combined(quotient, a, b, [&](const T& da, const T& db) { return T((da - quotient * db) * inverse); });
    }

    // With a plain number no derivative of it is touched.
    template <PlainNumber A>
    friend constexpr Dual operator+(const Dual& a, A b) {
        return Dual(T(a.value + Real(b)), a.derivative);
    }
    template <PlainNumber A>
    friend constexpr Dual operator+(A a, const Dual& b) {
        return b + a;
    }
    template <PlainNumber A>
    friend constexpr Dual operator-(const Dual& a, A b) {
        return Dual(T(a.value - Real(b)), a.derivative);
    }
    template <PlainNumber A>
    friend constexpr Dual operator-(A a, const Dual& b) {
        return combined(T(Real(a) - b.value), b, [](const T& db) { return T(-db); });
    }
    template <PlainNumber A>
    friend constexpr Dual operator*(const Dual& a, A b) {
        const Real factor = Real(b);
        return combined(T(a.value * factor), a, [&](const T& da) { return T(da * factor); });
    }
    template <PlainNumber A>
    friend constexpr Dual operator*(A a, const Dual& b) {
        return b * a;
    }
    template <PlainNumber A>
    friend constexpr Dual operator/(const Dual& a, A b) {
        const Real divisor = Real(b);
        return combined(T(a.value / divisor), a, [&](const T& da) { return T(da / divisor); });
    }
    friend constexpr bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
    friend constexpr std::partial_ordering operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }

    /// The dual with `value` whose derivatives are f(da), one per variable.
    template <class F>
    static constexpr Dual combined(const T& value, const Dual& a, const F& f) {
        Dual result;
        result.value = value;
        for (std::size_t i = 0; i < std::size_t(N); ++i) {
            result.derivative[i] = f(a.derivative[i]);
        }
        return result;
    }

    /// The dual with `value` whose derivatives are f(da, db), one per variable.
    template <class F>
    static constexpr Dual combined(const T& value, const Dual& a, const Dual& b, const F& f) {
        Dual result;
        result.value = value;
        for (std::size_t i = 0; i < std::size_t(N); ++i) {
            result.derivative[i] = f(a.derivative[i], b.derivative[i]);
        }
        return result;
    }

    /// Chain rule: the function value f and its derivative df at this value.
    constexpr Dual chained(const T& f, const T& df) const {
        return combined(f, *this, [&](const T& dx) { return T(df * dx); });
    }
};

template <class T, int N>
struct ScalarTraits<Dual<T, N>> {
    using Real = typename ScalarTraits<T>::Real;
    static constexpr Real value(const Dual<T, N>& x) { return ScalarTraits<T>::value(x.value); }
};

template <class T, int N>
Dual<T, N> abs(const Dual<T, N>& x) {
    return x < 0 ? -x : x;
}

template <class T, int N>
Dual<T, N> sqrt(const Dual<T, N>& x) {
    using std::sqrt;
    const T root = sqrt(x.value);
    return x.chained(root, T(1 / (2 * root)));
}

template <class T, int N>
Dual<T, N> exp(const Dual<T, N>& x) {
    using std::exp;
    const T e = exp(x.value);
    return x.chained(e, e);
}

template <class T, int N>
Dual<T, N> expm1(const Dual<T, N>& x) {
    using std::exp;
    using std::expm1;
    return x.chained(expm1(x.value), exp(x.value));
}

template <class T, int N>
Dual<T, N> log(const Dual<T, N>& x) {
    using std::log;
    return x.chained(log(x.value), T(1 / x.value));
}

template <class T, int N>
Dual<T, N> log1p(const Dual<T, N>& x) {
    using std::log1p;
    return x.chained(log1p(x.value), T(1 / (1 + x.value)));
}

/// x^p for a constant p; an integer p takes any x.
template <class T, int N, PlainNumber A>
Dual<T, N> pow(const Dual<T, N>& x, A p) {
    using std::pow;
    using Real = typename Dual<T, N>::Real;
    const Real exponent = Real(p);
    if (exponent == 0) {  // 0 * x^-1 would be NaN at x = 0
        return Dual<T, N>(1);
    }
    return x.chained(pow(x.value, exponent), T(exponent * pow(x.value, exponent - 1)));
}

/// x^y for x > 0.
template <class T, int N>
Dual<T, N> pow(const Dual<T, N>& x, const Dual<T, N>& y) {
    return exp(y * log(x));
}

template <class T, int N>
Dual<T, N> sin(const Dual<T, N>& x) {
    using std::cos;
    using std::sin;
    return x.chained(sin(x.value), cos(x.value));
}

template <class T, int N>
Dual<T, N> cos(const Dual<T, N>& x) {
    using std::cos;
    using std::sin;
    return x.chained(cos(x.value), T(-sin(x.value)));
}

template <class T, int N>
Dual<T, N> tan(const Dual<T, N>& x) {
    using std::tan;
    const T t = tan(x.value);
    return x.chained(t, T(1 + t * t));
}

template <class T, int N>
Dual<T, N> acos(const Dual<T, N>& x) {
    using std::acos;
    using std::sqrt;
    return x.chained(acos(x.value), T(-1 / sqrt(T(1 - x.value * x.value))));
}

/// The angle of (x, y); at the origin, where it has none, NaN derivatives.
template <class T, int N>
Dual<T, N> atan2(const Dual<T, N>& y, const Dual<T, N>& x) {
    using std::atan2;
    const T squared_radius = x.value * x.value + y.value * y.value;
    const T along_y = x.value / squared_radius;
    const T along_x = y.value / squared_radius;
    return Dual<T, N>::combined(atan2(y.value, x.value), y, x,
                                [&](const T& dy, const T& dx) { return T(along_y * dy - along_x * dx); });
}

template <class T, int N>
Dual<T, N> tanh(const Dual<T, N>& x) {
    using std::tanh;
    const T t = tanh(x.value);
    return x.chained(t, T(1 - t * t));
}

template <class T, int N>
Dual<T, N> erf(const Dual<T, N>& x) {
    using std::erf;
    using std::exp;
    using Real = typename Dual<T, N>::Real;
    const Real slope_at_zero = 2 * std::numbers::inv_sqrtpi_v<Real>;
    return x.chained(erf(x.value), T(slope_at_zero * exp(T(-(x.value * x.value)))));
}

}  // namespace softtissue

namespace Eigen {

/// Makes Dual an Eigen scalar; thresholds are those of the real number underneath.
template <class T, int N>
struct NumTraits<softtissue::Dual<T, N>> : NumTraits<softtissue::RealOf<softtissue::Dual<T, N>>> {
    using Real = softtissue::Dual<T, N>;
    using NonInteger = softtissue::Dual<T, N>;
    using Nested = softtissue::Dual<T, N>;
    using Literal = softtissue::RealOf<softtissue::Dual<T, N>>;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 0,
        ReadCost = (N + 1) * NumTraits<T>::ReadCost,
        AddCost = (N + 1) * NumTraits<T>::AddCost,
        MulCost = (N + 1) * NumTraits<T>::MulCost + 2 * N * NumTraits<T>::AddCost
    };
};

/// Lets plain scalars and matrices mix with dual ones: 2.0 * F, F * fibre.
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<softtissue::Dual<T, N>, softtissue::RealOf<softtissue::Dual<T, N>>, Operation> {
    using ReturnType = softtissue::Dual<T, N>;
};
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<softtissue::RealOf<softtissue::Dual<T, N>>, softtissue::Dual<T, N>, Operation> {
    using ReturnType = softtissue::Dual<T, N>;
};

}  // namespace Eigen
