// SPDX-License-Identifier: MIT
/// @file
/// Whether the cells below a skin triangle are valid, as one number that does not depend on the layer's scale.
///
/// What        relative_jacobian(): > 0 proves every prism below the triangle positive everywhere, and all tets of its
///             split; 1 for a vanishing thickness.
/// Equation    Columns x_i(s) = t_i + s h_i u_i, s = 0 at the skin, 1 inside. n_2, n_0: normals (twice the area) of the skin
///             and the inner triangle, n_1 = (e_0 x f_2 + f_0 x e_2) / 2 mixes their edges e, f. The Jacobian of the prism
///             has the nine Bernstein coefficients -n_k . h_i u_i; their ratios to those of the skin, k = 2, are
///                 r_ki = n_k . u_i / n_2 . u_i,   k = 0, 1.
///             Of the three tets of a layer two are corner Jacobians, hence covered; the third contains the column edge of the
///             middle vertex q (of ascending columns p < q < r): 6 volume / (-n_2 . h_q u_q / num_layers).
///             A layer is a part of the whole prism, so its Bernstein coefficients are positive if those of the prism are.
/// Valid       the smallest ratio; -1 if a direction does not point below the triangle.
/// Source      ratios of Bernstein coefficients: Johnen et al. 2013 for the bound; the measure is this library's.
/// Tests       tests/unit/anatomy/layer_validity_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace softtissue {

/// The geometry of a layer under construction; thickness may change, the rest is held by the caller.
template <RealScalar S>
struct LayerColumns {
    const Matrix3X<S>& skin_positions;  // t
    const Matrix3X<S>& directions;      // u, inwards, unit
    Index num_layers;

    /// x_i(s) of column i at thickness h.
    Vector3<S> position(std::int32_t i, S h, S s) const { return skin_positions.col(i) + s * h * directions.col(i); }
};

namespace detail {

/// Six times the volume of the middle tet of one layer, of the split whose side diagonals start at the smaller column.
template <RealScalar S>
S middle_tet_volume(const LayerColumns<S>& columns, const std::array<std::pair<std::int32_t, S>, 3>& ascending,
                    bool is_even, Index level) {
    const auto at = [&](size_t k, Index l) {
        const S s = S(1) - S(l) / S(columns.num_layers);
        return columns.position(ascending[k].first, ascending[k].second, s);
    };
    const Vector3<S> p = at(0, level);
    const Vector3<S> a = at(1, level) - p;
    const Vector3<S> b = at(1, level + 1) - p;
    const Vector3<S> c = at(2, level + 1) - p;
    return (is_even ? S(-1) : S(1)) * a.cross(b).dot(c);
}

}  // namespace detail

/// See the file comment; `triangle` of columns, `thickness` per column.
template <RealScalar S>
S relative_jacobian(const LayerColumns<S>& columns, const Vector3<std::int32_t>& triangle,
                    const VectorX<S>& thickness) {
    Matrix3<S> skin;
    Matrix3<S> inner;
    Matrix3<S> u;
    for (int k = 0; k < 3; ++k) {
        const std::int32_t i = triangle(k);
        skin.col(k) = columns.position(i, thickness(i), S(0));
        inner.col(k) = columns.position(i, thickness(i), S(1));
        u.col(k) = columns.directions.col(i);
    }
    const Vector3<S> e0 = skin.col(1) - skin.col(0);
    const Vector3<S> e2 = skin.col(2) - skin.col(0);
    const Vector3<S> f0 = inner.col(1) - inner.col(0);
    const Vector3<S> f2 = inner.col(2) - inner.col(0);
    const Vector3<S> limit = u.transpose() * e0.cross(e2);
    if (limit.maxCoeff() >= S(0)) {
        return S(-1);
    }
    const Vector3<S> inside = u.transpose() * f0.cross(f2);
    const Vector3<S> mixed = u.transpose() * ((e0.cross(f2) + f0.cross(e2)) / S(2));
    S smallest = std::min(inside.cwiseQuotient(limit).minCoeff(), mixed.cwiseQuotient(limit).minCoeff());

    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return triangle(a) < triangle(b); });
    const bool is_even = (order[1] - order[0] + 3) % 3 == 1;
    std::array<std::pair<std::int32_t, S>, 3> ascending;
    for (size_t k = 0; k < 3; ++k) {
        const std::int32_t i = triangle(order[k]);
        ascending[k] = {i, thickness(i)};
    }
    const S column_volume = -limit(order[1]) * ascending[1].second / S(columns.num_layers);
    for (Index level = 0; level < columns.num_layers; ++level) {
        smallest = std::min(smallest, detail::middle_tet_volume(columns, ascending, is_even, level) / column_volume);
    }
    return smallest;
}

}  // namespace softtissue
