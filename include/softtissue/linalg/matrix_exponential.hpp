// SPDX-License-Identifier: MIT
/// @file
/// The exponential of 3x3 matrices, one or many, and its derivative.
///
/// What        exp Q, and the gradient by Q of <G, exp Q>: the Frechet derivative of exp at Q^T applied to G
/// Equation    Q = t I + B, tr B = 0, B^3 = p B + q I (Cayley, Hamilton) with p = tr(B^2) / 2, q = det B; hence
///             exp Q = e^t (alpha I + beta B + gamma B^2): the Taylor polynomial of exp by Horner's rule modulo
///             x^3 - p x - q, two products a degree; for larger B of B / 2^s, squared s times
/// Shapes      3x3, any FieldScalar; many matrices at once: matrix_exponentials.hpp
/// Valid       every Q with |Q| < 1e10 whose exponential is finite. det exp Q = exp tr Q > 0.
/// Accuracy    in units of epsilon |exp Q| (Frobenius): below 3 up to |Q| = 2; up to |Q| = 10 below 3 in float, 12 in double;
///             beyond about |Q|, which is how far the rounding of Q itself moves the exponential
/// Source      scaling and squaring: Moler, Van Loan 2003, methods 3 and 10; derivative: Higham 2008, "Functions of Matrices",
///             ch. 10. With r = alpha + beta x + gamma x^2: dr/dp = x dr/dq modulo the same cubic.
/// Cost        200 flop (float) or 260 (double), with the derivative 500 or 650; beyond |B| = 2 (float) or 3 (double)
///             90 more a squaring, float matrices in double
/// Tests       tests/unit/linalg/matrix_exponential_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/core/branchless_exp.hpp>
#include <softtissue/linalg/matrix3_entries.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace softtissue {

namespace detail {

/// alpha + beta x + gamma x^2 = exp x modulo x^3 - p x - q, and the derivative of the three by q.
template <class S>
struct CubicExponential {
    S alpha, beta, gamma;
    S alpha_q, beta_q, gamma_q;
};

/// What the Taylor polynomials reach: truncation below a tenth of epsilon for |B| <= largest_norm (largest row sum).
template <class S>
struct ExponentialSeries {
    using Real = RealOf<S>;
    static constexpr bool is_float = sizeof(Real) == sizeof(float);
    static constexpr Real largest_norm = is_float ? Real(2) : Real(3);
    static constexpr std::size_t degree = is_float ? 15 : 29;

    static CubicExponential<S> at(const S& p, const S& q) { return at(p, q, std::make_index_sequence<degree + 1>()); }

private:
    static constexpr std::array<double, degree + 1> inverse_factorials = [] {
        std::array<double, degree + 1> result{1};
        for (std::size_t k = 1; k < result.size(); ++k) {
            result[k] = result[k - 1] / double(k);
        }
        return result;
    }();

    template <std::size_t... k>
    static CubicExponential<S> at(const S& p, const S& q, std::index_sequence<k...>) {
        CubicExponential<S> r{S(Real(0)), S(Real(0)), S(Real(0)), S(Real(0)), S(Real(0)), S(Real(0))};
        // r x + c modulo the cubic, the highest power first
        ((r = {r.gamma * q + S(Real(inverse_factorials[degree - k])), r.gamma * p + r.alpha, r.beta,
               r.gamma_q * q + r.gamma, r.gamma_q * p + r.alpha_q, r.beta_q}),
         ...);
        return r;
    }
};

/// t I + B with tr B = 0, and the coefficients of B^3 = p B + q I.
template <class S>
struct TraceSplit {
    S t;
    Matrix3Entries<S> B, B2;
    S p, q;

    TraceSplit(const Matrix3Entries<S>& Q, RealOf<S> scale) : B(Q) {
        const S third = S(RealOf<S>(1) / 3);
        t = Q.e[0] * third + Q.e[4] * third + Q.e[8] * third;  // no sum of large numbers
        B.e[0] = B.e[0] - t;
        B.e[4] = B.e[4] - t;
        B.e[8] = B.e[8] - t;
        B = entrywise([&](int i) { return S(B.e[i] * scale); });
        B2 = product(B, B);
        p = (B2.e[0] + B2.e[4] + B2.e[8]) * S(RealOf<S>(0.5));
        q = B.e[0] * (B.e[4] * B.e[8] - B.e[5] * B.e[7]) - B.e[1] * (B.e[3] * B.e[8] - B.e[5] * B.e[6]) +
            B.e[2] * (B.e[3] * B.e[7] - B.e[4] * B.e[6]);
    }
};

/// A quarter of the largest row sum: finite for every finite matrix.
template <class S>
RealOf<S> quarter_row_norm(const Matrix3Entries<S>& B) {
    const auto row = [&B](int i) {
        using std::abs;
        constexpr RealOf<S> quarter = RealOf<S>(0.25);
        return quarter * abs(value_of(B.e[i])) + quarter * abs(value_of(B.e[i + 1])) +
               quarter * abs(value_of(B.e[i + 2]));
    };
    const RealOf<S> a = row(0), b = row(3), c = row(6);
    const RealOf<S> larger = a > b ? a : b;
    return larger > c ? larger : c;
}

/// exp of one matrix, and the derivative of exp at this matrix applied to another.
template <class S>
struct ExponentialWithDerivative {
    Matrix3Entries<S> value, derivative;
};

template <class S>
Matrix3Entries<S> exponential_of(const TraceSplit<S>& A, const CubicExponential<S>& r, const S& factor) {
    const S alpha = r.alpha * factor, beta = r.beta * factor, gamma = r.gamma * factor;
    Matrix3Entries<S> X = entrywise([&](int i) { return S(gamma * A.B2.e[i] + beta * A.B.e[i]); });
    X.e[0] = X.e[0] + alpha;
    X.e[4] = X.e[4] + alpha;
    X.e[8] = X.e[8] + alpha;
    return X;
}

/// factor (beta E + gamma (E B + B E) + tr(r_p E) B + tr(r_q E) adj B) with r_p, r_q the derivatives of alpha I + beta B +
/// gamma B^2 by p and q, and a multiple of I that makes its trace that of X E, X = exp A.
template <class S>
Matrix3Entries<S> exponential_derivative_of(const TraceSplit<S>& A, const CubicExponential<S>& r, const S& factor,
                                            const Matrix3Entries<S>& X, const Matrix3Entries<S>& E) {
    const auto trace_of_product = [&E](const Matrix3Entries<S>& M) {
        return (M.e[0] * E.e[0] + M.e[1] * E.e[3] + M.e[2] * E.e[6]) +
               (M.e[3] * E.e[1] + M.e[4] * E.e[4] + M.e[5] * E.e[7]) +
               (M.e[6] * E.e[2] + M.e[7] * E.e[5] + M.e[8] * E.e[8]);
    };
    const S E1 = E.e[0] + E.e[4] + E.e[8], EB = trace_of_product(A.B), EB2 = trace_of_product(A.B2);
    const S P = factor * (r.gamma_q * A.q * E1 + (r.alpha_q + r.gamma_q * A.p) * EB + r.beta_q * EB2);
    const S R = factor * (r.alpha_q * E1 + r.beta_q * EB + r.gamma_q * EB2);
    const S beta = factor * r.beta, gamma = factor * r.gamma;
    const Matrix3Entries<S> right = product(E, A.B), left = product(A.B, E);
    Matrix3Entries<S> L = entrywise(
        [&](int i) { return S(beta * E.e[i] + gamma * (right.e[i] + left.e[i]) + P * A.B.e[i] + R * A.B2.e[i]); });
    // adj B = B^2 - p I, whose second part only changes the trace
    const S missing = (trace_of_product(X) - (L.e[0] + L.e[4] + L.e[8])) * S(RealOf<S>(1) / 3);
    L.e[0] = L.e[0] + missing;
    L.e[4] = L.e[4] + missing;
    L.e[8] = L.e[8] + missing;
    return L;
}

template <class S>
S exponential_of_scalar(const S& x) {
    if constexpr (std::is_floating_point_v<S>) {
        return branchless_exp(x);
    } else {
        return exp(x);
    }
}

template <class S>
bool needs_squaring(const Matrix3Entries<S>& B) {
    return quarter_row_norm(B) > ExponentialSeries<S>::largest_norm / 4;
}

/// Any matrix, with as many squarings as it needs.
template <class S>
ExponentialWithDerivative<S> squared_exponential(const Matrix3Entries<S>& Q, const Matrix3Entries<S>& E) {
    using Real = RealOf<S>;
    if constexpr (std::is_same_v<S, float>) {
        const auto converted = [](const auto& from, auto to) {
            std::copy(std::begin(from.e), std::end(from.e), to.e);
            return to;
        };
        const auto result =
            squared_exponential(converted(Q, Matrix3Entries<double>{}), converted(E, Matrix3Entries<double>{}));
        return {converted(result.value, Matrix3Entries<float>{}),
                converted(result.derivative, Matrix3Entries<float>{})};
    } else {
        const Real norm = quarter_row_norm(TraceSplit<S>(Q, Real(1)).B) / ExponentialSeries<S>::largest_norm;
        const int squarings = std::isfinite(norm) ? std::max(0, std::ilogb(norm) + 3) : 0;
        const Real scale = std::ldexp(Real(1), -squarings);
        const TraceSplit<S> A(Q, scale);
        // exp B alone would overflow for the largest B: then e^t is squared with it
        const bool is_large = squarings > 5;
        const S inner = is_large ? exponential_of_scalar(S(A.t * scale)) : S(Real(1));
        const S outer = is_large ? S(Real(1)) : exponential_of_scalar(S(A.t * Real(0.5)));
        const CubicExponential<S> r = ExponentialSeries<S>::at(A.p, A.q);
        Matrix3Entries<S> scaled = E;
        for (S& entry : scaled.e) {
            entry = entry * scale;
        }
        Matrix3Entries<S> X = exponential_of(A, r, inner);
        Matrix3Entries<S> L = exponential_derivative_of(A, r, inner, X, scaled);
        for (int k = 0; k < squarings; ++k) {
            const Matrix3Entries<S> right = product(L, X), left = product(X, L);
            for (int i = 0; i < 9; ++i) {
                L.e[i] = right.e[i] + left.e[i];
            }
            X = product(X, X);
        }
        for (int i = 0; i < 9; ++i) {
            X.e[i] = (X.e[i] * outer) * outer;
            L.e[i] = (L.e[i] * outer) * outer;
        }
        return {X, L};
    }
}

}  // namespace detail

/// exp Q.
template <FieldScalar S>
Matrix3<S> matrix_exponential(const Matrix3<S>& Q) {
    using namespace detail;
    Matrix3Entries<S> entries;
    std::copy(Q.data(), Q.data() + 9, entries.e);
    const TraceSplit<S> A(entries, RealOf<S>(1));
    const Matrix3Entries<S> X = needs_squaring(A.B)
                                    ? squared_exponential(entries, entries).value
                                    : exponential_of(A, ExponentialSeries<S>::at(A.p, A.q), exponential_of_scalar(A.t));
    return Eigen::Map<const Matrix3<S>>(X.e);
}

/// The gradient by Q of <G, exp Q>, the sum of the products of entries.
template <FieldScalar S>
Matrix3<S> matrix_exponential_pullback(const Matrix3<S>& Q, const Matrix3<S>& G) {
    using namespace detail;
    Matrix3Entries<S> entries, E;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            entries.e[3 * i + j] = Q(i, j);  // Q^T and G, column after column
            E.e[3 * i + j] = G(j, i);
        }
    }
    const TraceSplit<S> A(entries, RealOf<S>(1));
    Matrix3Entries<S> L;
    if (needs_squaring(A.B)) {
        L = squared_exponential(entries, E).derivative;
    } else {
        const CubicExponential<S> r = ExponentialSeries<S>::at(A.p, A.q);
        const S factor = exponential_of_scalar(A.t);
        L = exponential_derivative_of(A, r, factor, exponential_of(A, r, factor), E);
    }
    return Eigen::Map<const Matrix3<S>>(L.e);
}

}  // namespace softtissue
