// SPDX-License-Identifier: MIT
/// @file
/// Pairs of triangles that cross each other.
///
/// What        all pairs without a common vertex of which an edge of one passes through the inside of the other.
/// Shapes      positions 3 x n [m], triangles 3 x m; pairs ascending, smaller triangle first.
/// Valid       pairs that share a vertex are not tested: a fold at a common edge or vertex is not found. Touching or coplanar
///             triangles do not count as crossing.
/// Cost        a uniform grid with cells of the mean edge length; linear for surfaces of even resolution.
/// Tests       tests/unit/mesh/crossing_triangles_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

/// Whether the open segment from a to b passes through the inside of the triangle of the columns of `corners`.
template <RealScalar S>
bool segment_crosses_triangle(const Vector3<S>& a, const Vector3<S>& b, const Matrix3<S>& corners) {
    const auto volume = [](const Vector3<S>& p, const Vector3<S>& q, const Vector3<S>& r, const Vector3<S>& s) {
        return (q - p).cross(r - p).dot(s - p);
    };
    const Vector3<S> c0 = corners.col(0);
    const Vector3<S> c1 = corners.col(1);
    const Vector3<S> c2 = corners.col(2);
    if (!(volume(c0, c1, c2, a) * volume(c0, c1, c2, b) < S(0))) {
        return false;
    }
    const S v0 = volume(a, b, c0, c1);
    const S v1 = volume(a, b, c1, c2);
    const S v2 = volume(a, b, c2, c0);
    return (v0 > S(0) && v1 > S(0) && v2 > S(0)) || (v0 < S(0) && v1 < S(0) && v2 < S(0));
}

template <RealScalar S>
bool triangles_cross(const Matrix3<S>& p, const Matrix3<S>& q) {
    for (int k = 0; k < 3; ++k) {
        if (segment_crosses_triangle<S>(p.col(k), p.col((k + 1) % 3), q) ||
            segment_crosses_triangle<S>(q.col(k), q.col((k + 1) % 3), p)) {
            return true;
        }
    }
    return false;
}

/// Buckets of triangles by the grid cells that their bounding boxes touch, as sorted (cell, triangle) entries.
template <RealScalar S>
std::vector<std::pair<std::int64_t, std::int32_t>> grid_entries(const Matrix3X<S>& lower, const Matrix3X<S>& upper) {
    const Vector3<S> origin = lower.rowwise().minCoeff();
    const Vector3<S> extent = upper.rowwise().maxCoeff() - origin;
    // At most 2^20 cells an axis, so that three cell numbers fit 64 bits.
    const S spacing = std::max((upper - lower).colwise().norm().mean(), extent.maxCoeff() / S(1 << 20));
    std::vector<std::pair<std::int64_t, std::int32_t>> entries;
    const auto cell_of = [&](S coordinate, int axis) {
        return spacing > S(0) ? std::int64_t(std::floor((coordinate - origin(axis)) / spacing)) : 0;
    };
    for (Index t = 0; t < lower.cols(); ++t) {
        std::array<std::int64_t, 3> first{};
        std::array<std::int64_t, 3> last{};
        for (int axis = 0; axis < 3; ++axis) {
            first[size_t(axis)] = cell_of(lower(axis, t), axis);
            last[size_t(axis)] = cell_of(upper(axis, t), axis);
        }
        for (std::int64_t i = first[0]; i <= last[0]; ++i) {
            for (std::int64_t j = first[1]; j <= last[1]; ++j) {
                for (std::int64_t k = first[2]; k <= last[2]; ++k) {
                    entries.emplace_back((i << 42) | (j << 21) | k, static_cast<std::int32_t>(t));
                }
            }
        }
    }
    std::sort(entries.begin(), entries.end());
    return entries;
}

}  // namespace detail

template <RealScalar S>
std::vector<std::pair<std::int32_t, std::int32_t>> crossing_triangles(const Matrix3X<S>& positions,
                                                                      const Triangles& triangles) {
    std::vector<std::pair<std::int32_t, std::int32_t>> crossings;
    if (triangles.cols() == 0) {
        return crossings;
    }
    std::vector<Matrix3<S>> corners(size_t(triangles.cols()));
    Matrix3X<S> lower(3, triangles.cols());
    Matrix3X<S> upper(3, triangles.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        for (int k = 0; k < 3; ++k) {
            corners[size_t(t)].col(k) = positions.col(triangles(k, t));
        }
        lower.col(t) = corners[size_t(t)].rowwise().minCoeff();
        upper.col(t) = corners[size_t(t)].rowwise().maxCoeff();
    }
    const auto may_cross = [&](std::int32_t s, std::int32_t t) {
        if ((lower.col(s).array() > upper.col(t).array()).any() ||
            (lower.col(t).array() > upper.col(s).array()).any()) {
            return false;
        }
        for (int k = 0; k < 3; ++k) {
            if ((triangles.col(t).array() == triangles(k, s)).any()) {
                return false;
            }
        }
        return true;
    };
    const auto entries = detail::grid_entries(lower, upper);
    for (size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
        while (end < entries.size() && entries[end].first == entries[begin].first) {
            ++end;
        }
        for (size_t i = begin; i < end; ++i) {
            for (size_t j = i + 1; j < end; ++j) {
                const std::int32_t s = entries[i].second;
                const std::int32_t t = entries[j].second;
                if (may_cross(s, t) && detail::triangles_cross(corners[size_t(s)], corners[size_t(t)])) {
                    crossings.emplace_back(s, t);
                }
            }
        }
    }
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    return crossings;
}

}  // namespace softtissue
