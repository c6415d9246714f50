// SPDX-License-Identifier: MIT
/// @file
/// How far a prism of a layered body is from inversion, in numbers that do not depend on its size.
///
/// What        relative_coefficients(): the nine Bernstein coefficients n_k . d_i of the Jacobian (see Prism6) relative to
///             lengths and to the skin triangle's own angles; scaled_jacobian(): the usual measure of mesh quality.
/// Equation    corner i of the lower (k = 0) or upper (k = 2) triangle with edges e, f and column d_i:
///             r_ki = n_k . d_i / (|e| |f| |d_i| sin alpha_i),   alpha_i the angle of the skin's triangle at i;
///             k = 1: with the geometric mean of the lengths below and above.
///             scaled Jacobian = 2/sqrt(3) min over the six corners of n_k . d_i / (|e| |f| |d_i|).
/// Valid       r > 0 for all nine proves the prism positive everywhere. r is 1 for a right prism below any triangle, and does
///             not punish slivers of the skin that no wrap can change; the scaled Jacobian does.
/// Source      Johnen et al. 2013 (Bernstein bounds); scaled Jacobian: Knupp et al. 2006 (Verdict), wedge
/// Tests       tests/unit/anatomy/prism_quality_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace softtissue {

/// 1 / sin alpha_i of the corners of every triangle, 3 x m.
template <RealScalar S>
Matrix3X<S> inverse_corner_sines(const Matrix3X<S>& positions, const Triangles& triangles) {
    Matrix3X<S> inverse(3, triangles.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const Vector3<S> e = positions.col(triangles((i + 1) % 3, t)) - positions.col(triangles(i, t));
            const Vector3<S> f = positions.col(triangles((i + 2) % 3, t)) - positions.col(triangles(i, t));
            inverse(i, t) = e.norm() * f.norm() / e.cross(f).norm();
        }
    }
    return inverse;
}

/// The nodes of the prism between `triangle` of two surfaces with the same triangles.
template <RealScalar S>
Prism6::Nodes<S> nodes_between(const Triangles& triangles, Index triangle, const Matrix3X<S>& lower,
                               const Matrix3X<S>& upper) {
    Prism6::Nodes<S> X;
    for (int k = 0; k < 3; ++k) {
        X.col(k) = lower.col(triangles(k, triangle));
        X.col(k + 3) = upper.col(triangles(k, triangle));
    }
    return X;
}

/// n_k . d_i and the lengths they are measured by.
template <RealScalar S>
struct PrismCoefficients {
    Matrix3<S> values;   // n_k . d_i in row k, column i
    Matrix3<S> lengths;  // product of the three lengths, the same layout

    explicit PrismCoefficients(const Prism6::Nodes<S>& X) : values(Prism6::bernstein_jacobians(X)) {
        using std::sqrt;
        Vector3<S> below;
        Vector3<S> above;
        Vector3<S> column;
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            below(i) = (X.col(next) - X.col(i)).norm();
            above(i) = (X.col(next + 3) - X.col(i + 3)).norm();
            column(i) = (X.col(i + 3) - X.col(i)).norm();
        }
        for (int i = 0; i < 3; ++i) {
            const int previous = (i + 2) % 3;
            lengths(0, i) = below(i) * below(previous) * column(i);
            lengths(2, i) = above(i) * above(previous) * column(i);
            lengths(1, i) = sqrt(lengths(0, i) * lengths(2, i));
        }
    }
};

/// r_ki in row k, column i; a cell without extent gives zeros.
template <RealScalar S>
Matrix3<S> relative_coefficients(const Prism6::Nodes<S>& X, const Vector3<S>& inverse_sines) {
    const PrismCoefficients<S> c(X);
    return c.values.cwiseQuotient((c.lengths.array() + std::numeric_limits<S>::min()).matrix()) *
           inverse_sines.asDiagonal();
}

/// In [-1, 1] for the angles of a triangle at 60 degrees; at most 2/sqrt(3).
template <RealScalar S>
S scaled_jacobian(const Prism6::Nodes<S>& X) {
    const PrismCoefficients<S> c(X);
    const Matrix3<S> ratios = c.values.cwiseQuotient((c.lengths.array() + std::numeric_limits<S>::min()).matrix());
    return S(2) * std::numbers::inv_sqrt3_v<S> * std::min(ratios.row(0).minCoeff(), ratios.row(2).minCoeff());
}

}  // namespace softtissue
