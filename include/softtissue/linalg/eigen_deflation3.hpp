// SPDX-License-Identifier: MIT
/// @file
/// Diagonalises a symmetric 3x3 matrix without iterating to convergence: the isolated eigenvalue first, then a 2x2 matrix.
///
/// What        A = V diag(values) V^T: A becomes V, a rotation whose columns are the eigenvectors; values descending
/// Equation    D = A - (tr A / 3) I,  p^2 = tr D^2 / 6,  r = det D / (2 p^3) in [-1, 1]. The eigenvalue of D that lies farther from
///             the two others is sign(r) x p with x^3 - 3 x = 2 |r|, x in [sqrt 3, 2]; its eigenvector is a column of the adjugate
///             of D - sign(r) x p I, which has rank one; one plane rotation diagonalises A across it.
/// Shapes      A: 3x3, of which the lower triangle is read; values: 3
/// Valid       the largest entry about 1 in size. Repeated eigenvalues and zero: any basis of their space.
/// Accuracy    a few epsilon |A| in A V = V diag(values) and V^T V = I, for close eigenvalues too; equal ones are in order
///             to rounding only. Small eigenvalues have no relative accuracy.
/// Packs       no branch: no lane depends on the others
/// Source      Scherzinger, Dohrmann 2008, "A robust algorithm for finding the eigenvalues and eigenvectors of 3x3 symmetric
///             matrices"; basis across the eigenvector: Duff et al. 2017, "Building an Orthonormal Basis, Revisited"
/// Departs     x from a cubic and Newton steps in place of arc cosine and cosine
/// Cost        about 200 flop, a quarter of the time of Jacobi's sweeps
/// Tests       tests/unit/linalg/eigen_deflation3_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/jacobi_rotation.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace softtissue {

namespace detail {

/// The root x >= sqrt 3 of x^3 - 3 x = 2 q, 0 <= q <= 1.
template <class Scalar>
Scalar isolated_root(const Scalar& q) {
    using Real = RealOf<Scalar>;
    // Interpolates 2 cos(acos(q) / 3) to 8e-5; a Newton step squares that.
    Scalar x = ((q * Real(0.018639367794966707) - Real(0.0813823948457791)) * q + Real(0.3306607004416917)) * q +
               Real(1.7321326590663837);
    constexpr int num_steps = std::same_as<Real, float> ? 1 : 2;
    for (int step = 0; step < num_steps; ++step) {
        const Scalar squared = x * x;
        x -= ((squared - Real(3)) * x - Real(2) * q) * reciprocal(Scalar(Real(3) * squared - Real(3)));
    }
    return x;
}

/// The unit vector of the largest column of a symmetric positive or negative matrix of rank one: diagonal and, opposite
/// to each of its entries, what is beside it.
template <class Scalar>
Vector3<Scalar> largest_direction(const Vector3<Scalar>& diagonal, const Vector3<Scalar>& beside) {
    using std::abs;
    using std::max;
    const Scalar size0 = abs(diagonal(0)), size1 = abs(diagonal(1)), size2 = abs(diagonal(2));
    const auto is_1 = size1 > size0;
    const auto is_2 = size2 > max(size0, size1);
    const auto of_three = [&](const Scalar& a, const Scalar& b, const Scalar& c) {
        return select(is_2, c, select(is_1, b, a));
    };
    const Vector3<Scalar> column(of_three(diagonal(0), beside(2), beside(1)),
                                 of_three(beside(2), diagonal(1), beside(0)),
                                 of_three(beside(1), beside(0), diagonal(2)));
    return column * reciprocal_sqrt(Scalar(column.dot(column)));
}

}  // namespace detail

/// A, largest entry about 1 in size, becomes the matrix of its eigenvectors; the eigenvalues. As diagonalise_by_ql().
template <RealLanes Scalar>
Vector3<Scalar> diagonalise_by_deflation(Matrix3<Scalar>& A) {
    using std::abs;
    using std::max;
    using std::min;
    using Real = RealOf<Scalar>;
    using Vector = Vector3<Scalar>;
    using Limits = std::numeric_limits<Real>;
    const Scalar zero(0), one(1);
    const Vector beside(A(2, 1), A(2, 0), A(1, 0));
    const Scalar mean = (A(0, 0) + A(1, 1) + A(2, 2)) * Real(1.0 / 3.0);
    Vector d(A(0, 0) - mean, A(1, 1) - mean, A(2, 2) - mean);
    const Vector squared(beside(0) * beside(0), beside(1) * beside(1), beside(2) * beside(2));

    // Where D is nothing but rounding, any direction is an eigenvector.
    const Scalar squared_size = max((d.dot(d) + Real(2) * (squared(0) + squared(1) + squared(2))) * Real(1.0 / 6.0),
                                    Scalar(Limits::epsilon() * Limits::epsilon() / Real(64)));
    const Scalar inverse_size = reciprocal_sqrt(squared_size);
    const Scalar determinant = d(0) * d(1) * d(2) + Real(2) * (beside(0) * beside(1) * beside(2)) - d.dot(squared);
    const Scalar r = ((determinant * Real(0.5)) * inverse_size) * (inverse_size * inverse_size);
    const auto is_smallest = r < zero;
    const Scalar size = detail::isolated_root(min(Scalar(abs(r)), one)) * (squared_size * inverse_size);
    const Scalar isolated = select(is_smallest, Scalar(-size), size);
    for (int k = 0; k < 3; ++k) {
        d(k) -= isolated;
    }
    Vector adjugate, adjugate_beside;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        adjugate(k) = d(i) * d(j) - squared(k);
        adjugate_beside(k) = beside(i) * beside(j) - beside(k) * d(k);
    }
    const Vector v = detail::largest_direction(adjugate, adjugate_beside);

    const Scalar side = select(v(2) < zero, Scalar(-1), one);
    const Scalar a = -reciprocal(Scalar(side + v(2)));
    const Scalar b = v(0) * v(1) * a;
    const Vector u(one + side * (v(0) * v(0) * a), side * b, -(side * v(0)));
    const Vector w(b, side + v(1) * v(1) * a, -v(1));
    const auto times = [&](const Vector& x) {
        return Vector(A(0, 0) * x(0) + beside(2) * x(1) + beside(1) * x(2),
                      beside(2) * x(0) + A(1, 1) * x(1) + beside(0) * x(2),
                      beside(1) * x(0) + beside(0) * x(1) + A(2, 2) * x(2));
    };
    const Vector Au = times(u), Aw = times(w);
    const Scalar uAu = u.dot(Au), wAw = w.dot(Aw), uAw = w.dot(Au);
    const JacobiRotation<Scalar> rotation(Scalar(wAw - uAu), Scalar(uAw + uAw));
    const auto is_coupled = uAw * uAw > Scalar(Limits::min());
    const Scalar shift = select(is_coupled, Scalar(rotation.tangent * uAw), zero);
    const Scalar cosine = select(is_coupled, rotation.cosine, one);
    const Scalar sine = select(is_coupled, rotation.sine, zero);
    const Scalar first = uAu - shift, second = wAw + shift;
    // The rotation is by 45 degrees at most; a quarter turn more exchanges the two.
    const auto is_ascending = first < second;
    const Scalar c = select(is_ascending, sine, cosine);
    const Scalar s = select(is_ascending, Scalar(-cosine), sine);
    const Vector larger = c * u - s * w, smaller = s * u + c * w;
    for (int i = 0; i < 3; ++i) {
        A(i, 0) = select(is_smallest, larger(i), v(i));
        A(i, 1) = select(is_smallest, smaller(i), larger(i));
        A(i, 2) = select(is_smallest, v(i), smaller(i));
    }
    const Scalar value = mean + isolated;
    const Scalar large = max(first, second), small = min(first, second);
    return {select(is_smallest, large, value), select(is_smallest, small, large), select(is_smallest, value, small)};
}

}  // namespace softtissue
