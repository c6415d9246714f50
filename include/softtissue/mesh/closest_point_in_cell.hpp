// SPDX-License-Identifier: MIT
/// @file
/// The point of a tet or prism that is closest to a point.
///
/// What        its natural coordinates, inside or on the boundary of the reference cell, and its squared distance: 0 for a
///             point in the cell.
/// Method      Tet4: closest of the points on the four faces. Prism6: from the s that the inverse map found, in turn the
///             closest point of the triangle at s and of the column (the segment between facing nodes) through it, both
///             exact, until s rests; the distance never grows.
/// Shapes      X 3 x num_nodes [m]; natural coordinates as the element has them.
/// Valid       cells with a positive Jacobian. The sides of a prism are curved: the point found is where the distance
///             cannot be lowered along the triangle nor along the column, hence a local minimum.
/// Cost        Prism6 outside: each turn lowers the error by cos^2 of the angle between the column and the triangle or
///             edge it is tied to: two turns for a right prism, at most max_turns.
/// Tests       tests/unit/mesh/closest_point_in_cell_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/closest_point_on_triangle.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace softtissue {

template <RealScalar S>
struct CellPoint {
    Vector3<S> coordinates;
    S squared_distance;
};

/// Whether natural coordinates belong to the closed reference cell; NaN does not.
template <class ElementType, RealScalar S>
    requires std::is_same_v<ElementType, Tet4>
bool is_in_reference_cell(const Vector3<S>& xi) {
    return xi(0) >= S(0) && xi(1) >= S(0) && xi(2) >= S(0) && xi.sum() <= S(1);
}

template <class ElementType, RealScalar S>
    requires std::is_same_v<ElementType, Prism6>
bool is_in_reference_cell(const Vector3<S>& xi) {
    return xi(0) >= S(0) && xi(1) >= S(0) && xi(0) + xi(1) <= S(1) && xi(2) >= S(-1) && xi(2) <= S(1);
}

namespace detail {

template <RealScalar S>
CellPoint<S> closest_point_on_boundary(const Tet4::Nodes<S>& X, const Vector3<S>& p, const NaturalCoordinates<S>&) {
    CellPoint<S> best{Vector3<S>::Zero(), std::numeric_limits<S>::infinity()};
    for (const ElementFace& face : Tet4::faces) {
        Matrix3<S> corners;
        for (int k = 0; k < 3; ++k) {
            corners.col(k) = X.col(face.nodes[size_t(k)]);
        }
        const TrianglePoint<S> candidate = closest_point_on_triangle<S>(corners, p);
        if (candidate.squared_distance < best.squared_distance) {
            Tet4::Values<S> N = Tet4::Values<S>::Zero();
            for (int k = 0; k < 3; ++k) {
                N(face.nodes[size_t(k)]) = candidate.barycentric(k);
            }
            best = {N.template tail<3>(), candidate.squared_distance};
        }
    }
    return best;
}

template <RealScalar S>
CellPoint<S> closest_point_on_boundary(const Prism6::Nodes<S>& X, const Vector3<S>& p,
                                       const NaturalCoordinates<S>& guess) {
    constexpr int max_turns = 200;  // 1e-12 of the way is left after them where columns lean by 68 degrees
    constexpr S rest = S(4) * std::numeric_limits<S>::epsilon();
    const Prism6::Nodes<S> Y = X.colwise() - p;
    const S guessed = (S(1) + guess.coordinates(2)) / S(2);
    S s = guess.converged && std::isfinite(guessed) ? std::clamp(guessed, S(0), S(1)) : S(0.5);
    TrianglePoint<S> foot{};
    for (int turn = 0; turn < max_turns; ++turn) {
        const Matrix3<S> triangle = (S(1) - s) * Y.template leftCols<3>() + s * Y.template rightCols<3>();
        foot = closest_point_on_triangle<S>(triangle, Vector3<S>::Zero());
        const Vector3<S> bottom = Y.template leftCols<3>() * foot.barycentric;
        const Vector3<S> top = Y.template rightCols<3>() * foot.barycentric;
        const S before = s;
        s = closest_point_on_segment<S>(bottom, top, Vector3<S>::Zero());
        foot.squared_distance = (bottom + s * (top - bottom)).squaredNorm();
        if (std::abs(s - before) <= rest) {
            break;
        }
    }
    return {Vector3<S>(foot.barycentric(1), foot.barycentric(2), S(2) * s - S(1)), foot.squared_distance};
}

}  // namespace detail

template <class ElementType, RealScalar S>
    requires std::is_same_v<ElementType, Tet4> || std::is_same_v<ElementType, Prism6> CellPoint<S>
    closest_point_in_cell(const NodePositions<ElementType, S>& X, const Vector3<S>& p) {
        const NaturalCoordinates<S> found = ElementType::natural_coordinates(X, p);
        if (found.converged && is_in_reference_cell<ElementType, S>(found.coordinates)) {
            return {found.coordinates, S(0)};
        }
        return detail::closest_point_on_boundary<S>(X, p, found);
    }

}  // namespace softtissue
