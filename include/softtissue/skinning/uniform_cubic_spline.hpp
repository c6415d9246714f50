// SPDX-License-Identifier: MIT
/// @file
/// C2 cubic spline through values at 0, 1, 2, ...
///
/// What        interpolation of several functions at once; the not-a-knot spline.
/// Equation    y(i + s) = (1-s) y_i + s y_{i+1} + ((1-s)^3 - (1-s))/6 m_i + (s^3 - s)/6 m_{i+1},
///             m_{i-1} + 4 m_i + m_{i+1} = 6 (y_{i-1} - 2 y_i + y_{i+1}),  m_0 = 2 m_1 - m_2, likewise at the end
/// Shapes      values functions x knots; m (second derivatives) the same.
/// Valid       one knot: constant; two: linear; three: parabola; from four on cubics are reproduced. Exact at knots.
/// Refuses     no knots (InvalidInput). Arguments outside [0, knots - 1] extend the first and last cubic.
/// Source      de Boor 2001, "A Practical Guide to Splines", ch. IV
/// Cost        one tridiagonal solve per function; 8 flop per function and argument
/// Tests       tests/unit/skinning/uniform_cubic_spline_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace softtissue {

template <RealScalar S>
class UniformCubicSpline {
public:
    /// `values` functions x knots.
    explicit UniformCubicSpline(MatrixX<S> values) : values_(std::move(values)) {
        require(values_.cols() > 0, "cubic spline: no knots, expected at least one");
        const Index last = values_.cols() - 1;
        second_ = MatrixX<S>::Zero(values_.rows(), values_.cols());
        if (last < 2) {
            return;
        }
        const auto difference = [this](Index i) -> VectorX<S> {
            return values_.col(i - 1) - S(2) * values_.col(i) + values_.col(i + 1);
        };
        // The end conditions turn the first and the last equation into m_1 = y_0 - 2 y_1 + y_2 and its mirror.
        second_.col(1) = difference(1);
        second_.col(last - 1) = difference(last - 1);
        solve_interior(difference, last);
        second_.col(0) = last > 2 ? VectorX<S>(S(2) * second_.col(1) - second_.col(2)) : VectorX<S>(second_.col(1));
        second_.col(last) =
            last > 2 ? VectorX<S>(S(2) * second_.col(last - 1) - second_.col(last - 2)) : VectorX<S>(second_.col(1));
    }

    Index num_functions() const { return values_.rows(); }
    Index num_knots() const { return values_.cols(); }

    /// All functions at `u`, in units of knots.
    VectorX<S> operator()(S u) const {
        if (num_knots() == 1) {
            return values_.col(0);
        }
        const Index i = std::clamp(Index(std::floor(u)), Index(0), num_knots() - 2);
        const S s = u - S(i);
        const S r = S(1) - s;
        return r * values_.col(i) + s * values_.col(i + 1) + (r * r * r - r) / S(6) * second_.col(i) +
               (s * s * s - s) / S(6) * second_.col(i + 1);
    }

private:
    /// m_2 .. m_{last-2} by elimination of the (1, 4, 1) system, its neighbours known.
    template <class Difference>
    void solve_interior(const Difference& difference, Index last) {
        const Index first = 2, end = last - 1;  // [first, end)
        if (first >= end) {
            return;
        }
        VectorX<S> upper(last);  // eliminated super-diagonal
        S previous(0);
        for (Index i = first; i < end; ++i) {
            VectorX<S> right = S(6) * difference(i) - second_.col(i - 1);
            if (i == end - 1) {
                right -= second_.col(end);
            }
            const S pivot = S(4) - previous;
            second_.col(i) = right / pivot;
            previous = S(1) / pivot;
            upper(i) = previous;
        }
        for (Index i = end - 2; i >= first; --i) {
            second_.col(i) -= upper(i) * second_.col(i + 1);
        }
    }

    MatrixX<S> values_;
    MatrixX<S> second_;
};

}  // namespace softtissue
