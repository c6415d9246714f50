// SPDX-License-Identifier: MIT
/// @file
/// Whether points lie inside a closed triangle surface.
///
/// What        the winding number of a point by the signed crossings of the ray from it along +z.
/// Shapes      positions 3 x n [m], triangles 3 x m, facing outwards.
/// Valid       closed, consistently oriented surfaces, also of several pieces or crossing themselves (then > 1 or < 0).
///             A ray through an edge is counted for exactly one of its two sides. Within rounding of the surface either answer.
/// Refuses     a surface that is not closed (InvalidInput names the edge)
/// Cost        triangles are sorted into columns of about their own size once; a query looks at those of one column.
/// Tests       tests/unit/mesh/inside_surface_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/adjacency.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
class InsideSurface {
public:
    InsideSurface(Matrix3X<S> positions, Triangles triangles)
        : positions_(std::move(positions)), triangles_(std::move(triangles)) {
        const TriangleMesh mesh(triangles_, positions_.cols());
        for (const TriangleMesh::Edge& edge : mesh.edges()) {
            require(!edge.is_boundary(), "surface: edge (", edge.vertices[0], ", ", edge.vertices[1],
                    ") belongs to triangle ", edge.triangles[0], " only, expected a closed surface");
        }
        sort_into_columns();
    }

    /// 1 inside, 0 outside of a surface that does not cross itself.
    int winding_number(const Vector3<S>& p) const {
        int number = 0;
        const Vector3<S> place = (p - corner_) / width_;
        if (place(0) < S(0) || place(1) < S(0) || place(0) >= S(counts_[0]) || place(1) >= S(counts_[1])) {
            return 0;
        }
        for (const std::int32_t t : columns_.row(column(Index(place(0)), Index(place(1))))) {
            number += crossing(t, p);
        }
        return number;
    }

    bool contains(const Vector3<S>& p) const { return winding_number(p) > 0; }

private:
    Index column(Index i, Index j) const { return i + counts_[0] * j; }

    void sort_into_columns() {
        const Vector3<S> lower = positions_.rowwise().minCoeff();
        const Vector3<S> extent = positions_.rowwise().maxCoeff() - lower;
        const S area = std::max(extent(0) * extent(1), extent.squaredNorm() * S(1e-6));
        width_ = std::sqrt(area / S(triangles_.cols()));
        corner_ = lower;
        counts_[0] = Index(extent(0) / width_) + 1;
        counts_[1] = Index(extent(1) / width_) + 1;
        std::vector<std::pair<std::int32_t, std::int32_t>> entries;
        for (Index t = 0; t < triangles_.cols(); ++t) {
            Matrix3<S> corners;
            for (int k = 0; k < 3; ++k) {
                corners.col(k) = (positions_.col(triangles_(k, t)) - corner_) / width_;
            }
            const Vector3<S> low = corners.rowwise().minCoeff();
            const Vector3<S> high = corners.rowwise().maxCoeff();
            for (Index j = Index(low(1)); j <= Index(high(1)); ++j) {
                for (Index i = Index(low(0)); i <= Index(high(0)); ++i) {
                    entries.emplace_back(static_cast<std::int32_t>(column(i, j)), static_cast<std::int32_t>(t));
                }
            }
        }
        columns_ = Adjacency(counts_[0] * counts_[1], entries);
    }

    /// Seen along z, twice the area of a, b and p. Both triangles at an edge evaluate it from the smaller to the larger
    /// vertex, so that a point belongs to one of its sides even after rounding.
    S turn(std::int32_t a, std::int32_t b, const Vector3<S>& p) const {
        if (a > b) {
            return -turn(b, a, p);
        }
        const Vector3<S> e = positions_.col(b) - positions_.col(a);
        const Vector3<S> d = p - positions_.col(a);
        return e(0) * d(1) - e(1) * d(0);
    }

    static bool is_left(std::int32_t a, std::int32_t b, S turn) { return a < b ? turn >= S(0) : turn > S(0); }

    /// +1 where the ray leaves through triangle t, -1 where it enters, else 0.
    int crossing(std::int32_t t, const Vector3<S>& p) const {
        Vector3<S> turns;
        int left = 0;
        for (int k = 0; k < 3; ++k) {
            const std::int32_t a = triangles_((k + 1) % 3, t);
            const std::int32_t b = triangles_((k + 2) % 3, t);
            turns(k) = turn(a, b, p);
            left += is_left(a, b, turns(k)) ? 1 : 0;
        }
        if (left != 0 && left != 3) {
            return 0;
        }
        S height(0);
        for (int k = 0; k < 3; ++k) {
            height += turns(k) * (positions_(2, triangles_(k, t)) - p(2));
        }
        // `height` has the sign of the crossing's distance times that of the turns.
        return left == 3 ? (height > S(0) ? 1 : 0) : (height < S(0) ? -1 : 0);
    }

    Matrix3X<S> positions_;
    Triangles triangles_;
    Vector3<S> corner_;
    S width_;
    std::array<Index, 2> counts_;
    Adjacency columns_;
};

}  // namespace softtissue
