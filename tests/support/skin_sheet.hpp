// SPDX-License-Identifier: MIT
// Sheets of triangles to stretch and to bend.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/testing/random_states.hpp>

#include <cmath>
#include <cstdint>

namespace softtissue_test {

using namespace softtissue;

template <class S>
struct SkinSheet {
    TriangleMesh surface;
    Matrix3X<S> positions;
};

/// A flat rhombus of 2 n^2 equilateral triangles in the plane z = 0, facing up; rows of edges along x.
template <class S = double>
SkinSheet<S> equilateral_sheet(int n, double edge) {
    Matrix3X<S> positions(3, (n + 1) * (n + 1));
    Triangles triangles(3, 2 * n * n);
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            positions.col(i + (n + 1) * j) << S(edge * (i + 0.5 * j)), S(edge * std::sqrt(0.75) * j), S(0);
        }
    }
    Index t = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const int v = i + (n + 1) * j;
            triangles.col(t++) << v, v + 1, v + n + 1;
            triangles.col(t++) << v + 1, v + n + 2, v + n + 1;
        }
    }
    return {TriangleMesh(triangles, positions.cols()), positions};
}

/// The same with bumps and noise of about a fifth of an edge: a curved rest shape of irregular triangles.
template <class S = double>
SkinSheet<S> bumpy_sheet(int n, double edge, std::uint64_t seed = 1) {
    SkinSheet<S> sheet = equilateral_sheet<S>(n, edge);
    RandomGenerator random(seed);
    for (Index k = 0; k < sheet.positions.size(); ++k) {
        sheet.positions.data()[k] += S(0.15 * edge * random.normal());
    }
    return sheet;
}

/// Two triangles over the edge (0, 1) of length 1 along x, `height` high, flat; the second one bent down by `angle`.
template <class S = double>
SkinSheet<S> single_hinge(double angle, double height = 0.8, double second_height = 0.8) {
    Matrix3X<S> positions(3, 4);
    positions << S(0), S(1), S(0.4), S(0.6),                              //
        S(0), S(0), S(height), S(-second_height * std::cos(angle)),       //
        S(0), S(0), S(0), S(-second_height * std::sin(angle));
    Triangles triangles(3, 2);
    triangles << 0, 1, 1, 0, 2, 3;
    return {TriangleMesh(triangles, 4), positions};
}

}  // namespace softtissue_test
