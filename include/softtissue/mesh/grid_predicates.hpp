// SPDX-License-Identifier: MIT
/// @file
/// On which side of a plane, and whether inside a sphere: decided exactly, for points on a fine grid.
///
/// What        to_grid(): positions rounded to whole numbers; orientation(), sphere_side(): signs without rounding error.
/// Equation    orientation(a, b, c, d) = sign det [b - a, c - a, d - a], +1 for the positive tet of Tet4;
///             sphere_side(a, b, c, d, p) = +1 if p is inside the sphere through the corners of a positive tet, 0 on it.
/// Shapes      grid points 3, whole numbers in [0, 2^24]; grid unit = largest extent / 2^24 (0.12 um for a 2 m body).
/// Valid       grid points only: their differences and 2x2 minors are exact in double, products of these are split by fma.
///             Degenerate sets of points (on one plane, on one sphere) give 0, consistently.
/// Refuses     to_grid(): positions that are not finite (InvalidInput names the vertex)
/// Source      Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates":
///             filter and expansion sum.
/// Tests       tests/unit/mesh/grid_predicates_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>

namespace softtissue {

/// The positions on the grid that spans their bounding box.
template <RealScalar S>
Matrix3X<double> to_grid(const Matrix3X<S>& positions) {
    for (Index v = 0; v < positions.cols(); ++v) {
        require(positions.col(v).allFinite(), "grid: position of vertex ", v, " is not finite");
    }
    Matrix3X<double> points = positions.template cast<double>();
    if (points.cols() > 0) {
        const Vector3<double> corner = points.rowwise().minCoeff();
        points.colwise() -= corner;
        const double extent = points.maxCoeff();
        const double scale = extent > 0.0 ? 0x1p24 / extent : 1.0;
        points = (scale * points).array().round().matrix();
    }
    return points;
}

namespace detail {

/// A sum of doubles held exactly, as components that do not overlap, smallest first.
class ExactSum {
public:
    void add(double value) {
        size_t kept = 0;
        for (size_t i = 0; i < size_; ++i) {
            const double sum = value + components_[i];
            const double virtual_part = sum - value;
            const double error = (value - (sum - virtual_part)) + (components_[i] - virtual_part);
            value = sum;
            if (error != 0.0) {
                components_[kept++] = error;
            }
        }
        if (value != 0.0) {
            components_[kept++] = value;
        }
        size_ = kept;
    }

    void add_product(double a, double b) {
        const double product = a * b;
        add(product);
        add(std::fma(a, b, -product));
    }

    void add_product(double a, double b, double c) {
        const double product = a * b;
        add_product(product, c);
        add_product(std::fma(a, b, -product), c);
    }

    int sign() const { return size_ == 0 ? 0 : components_[size_ - 1] > 0.0 ? 1 : -1; }

private:
    std::array<double, 64> components_{};  // at most one per number added: 48 in sphere_side()
    size_t size_ = 0;
};

inline int sign_of(double x) {
    return x > 0.0 ? 1 : x < 0.0 ? -1 : 0;
}

}  // namespace detail

inline int orientation(const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c,
                       const Vector3<double>& d) {
    const Vector3<double> normal = (b - a).cross(c - a);  // exact: each entry below 2^49
    const Vector3<double> to = d - a;
    const Vector3<double> terms = normal.cwiseProduct(to);
    const double determinant = terms.sum();
    // Five roundings of at most 2^-53 each.
    if (std::abs(determinant) > 0x1p-50 * terms.cwiseAbs().sum()) {
        return detail::sign_of(determinant);
    }
    detail::ExactSum sum;
    for (int i = 0; i < 3; ++i) {
        sum.add_product(normal(i), to(i));
    }
    return sum.sign();
}

inline int sphere_side(const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c,
                       const Vector3<double>& d, const Vector3<double>& p) {
    // The determinant of the rows (v - p, |v - p|^2), expanded along the squares: 12 products of three exact numbers.
    const std::array<Vector3<double>, 4> rows{a - p, b - p, c - p, d - p};
    std::array<std::array<double, 3>, 12> factors;
    double determinant = 0.0;
    double magnitude = 0.0;
    for (size_t i = 0; i < 4; ++i) {
        const double square = (i % 2 == 0 ? 1.0 : -1.0) * rows[i].squaredNorm();
        const Vector3<double>& r = rows[i == 0 ? 1 : 0];
        const Vector3<double> minors = rows[i <= 1 ? 2 : 1].cross(rows[i <= 2 ? 3 : 2]);
        for (size_t k = 0; k < 3; ++k) {
            factors[3 * i + k] = {square, r(Index(k)), minors(Index(k))};
            const double term = square * r(Index(k)) * minors(Index(k));
            determinant += term;
            magnitude += std::abs(term);
        }
    }
    // Fourteen roundings of at most 2^-53 each.
    if (std::abs(determinant) > 0x1p-49 * magnitude) {
        return detail::sign_of(determinant);
    }
    detail::ExactSum sum;
    for (const std::array<double, 3>& f : factors) {
        sum.add_product(f[0], f[1], f[2]);
    }
    return sum.sign();
}

}  // namespace softtissue
