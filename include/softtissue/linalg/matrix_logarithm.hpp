// SPDX-License-Identifier: MIT
/// @file
/// The principal logarithm of a 3x3 matrix.
///
/// What        the Q with exp Q = F whose eigenvalues have imaginary parts between -pi and pi, if there is one
/// Equation    log F = 2^k log F^(1/2^k), k square roots until |F^(1/2^k) - I| < 1/4;
///             log A = 2 (Z + Z^3/3 + Z^5/5 + ...), Z = (A + I)^-1 (A - I);
///             then one correction Q + D - D^2/2 with I + D = exp(-Q) F
/// Shapes      3x3, float and double
/// Valid       every finite F. No value where an eigenvalue is zero or negative (det F <= 0, rotations by pi), nor so
///             close to it that the result does not reproduce F to sqrt(epsilon).
/// Accuracy    a few epsilon |F| |F^-1|; an eigenvalue at an angle of pi - d costs a factor 1 / d^2. float in double.
/// Source      inverse scaling and squaring: Kenney, Laub 1989; square roots: the product form of Denman and Beavers' iteration,
///             Cheng, Higham, Kenney, Laub 2001
/// Cost        some 10 inverses of 3x3 a square root, one to three roots for |log F| < 1
/// Tests       tests/unit/linalg/matrix_logarithm_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/matrix_exponential.hpp>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <optional>

namespace softtissue {

namespace detail {

/// The square root with eigenvalues in the right half-plane, if the iteration finds it.
inline std::optional<Matrix3<double>> principal_square_root(const Matrix3<double>& A) {
    constexpr int max_iterations = 60;  // 6 to 10, and one more for each halving of an eigenvalue's angle to -pi
    constexpr double accurate = 64 * std::numeric_limits<double>::epsilon();
    const Matrix3<double> I = Matrix3<double>::Identity();
    Matrix3<double> M = A, X = A;
    for (int k = 0; k < max_iterations; ++k) {
        const Matrix3<double> inverse = M.inverse();
        X = 0.5 * (X + X * inverse);
        M = 0.5 * I + 0.25 * (M + inverse);
        const double distance = (M - I).norm();
        if (!std::isfinite(distance)) {
            return std::nullopt;
        }
        if (distance <= accurate) {
            return X;
        }
    }
    return std::nullopt;
}

}  // namespace detail

/// log F, or nothing where there is none.
template <RealScalar S>
std::optional<Matrix3<S>> matrix_logarithm(const Matrix3<S>& F) {
    constexpr int max_roots = 60, num_terms = 10;  // 1/7^20 < 1e-16
    const Matrix3<double> I = Matrix3<double>::Identity(), exact = F.template cast<double>();
    if (!(exact.determinant() > 0)) {
        return std::nullopt;
    }
    Matrix3<double> A = exact;
    double scale = 2;
    for (int k = 0; !((A - I).norm() < 0.25); ++k) {
        const std::optional<Matrix3<double>> root = detail::principal_square_root(A);
        if (!root || k == max_roots) {
            return std::nullopt;
        }
        A = *root;
        scale *= 2;
    }
    const Matrix3<double> Z = (A + I).inverse() * (A - I), Z2 = Z * Z;
    Matrix3<double> series = I / (2 * num_terms - 1);
    for (int n = num_terms - 2; n >= 0; --n) {
        series = series * Z2 + I / (2 * n + 1);
    }
    Matrix3<double> Q = scale * (Z * series);
    const Matrix3<double> D = matrix_exponential<double>(-Q) * exact - I;
    Q += D - 0.5 * D * D;
    const double difference = (matrix_exponential(Q) - exact).norm();
    if (!(difference <= double(std::sqrt(std::numeric_limits<S>::epsilon())) * exact.norm())) {
        return std::nullopt;
    }
    return Q.cast<S>();
}

}  // namespace softtissue
