// SPDX-License-Identifier: MIT
#include <softtissue/mesh/edge_distance.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("distances follow the edges and stay infinite on other pieces", S, float, double) {
    // A unit square with one diagonal, and a triangle apart.
    Matrix3X<S> positions(3, 7);
    positions << 0, 1, 1, 0, 5, 6, 5,  //
        0, 0, 1, 1, 0, 0, 1,           //
        0, 0, 0, 0, 0, 0, 0;
    Triangles triangles(3, 3);
    triangles << 0, 0, 4, 1, 2, 5, 2, 3, 6;
    const TriangleMesh mesh(triangles, 7);
    const std::vector<std::int32_t> corner{1};
    const VectorX<S> from_corner = edge_distances<S>(mesh, positions, corner);
    CHECK(from_corner(1) == S(0));
    CHECK(from_corner(0) == S(1));
    CHECK(from_corner(2) == S(1));
    CHECK(from_corner(3) == S(2));  // no edge joins 1 and 3
    CHECK(std::isinf(from_corner(4)));

    const std::vector<std::int32_t> several{0, 3, 4};
    const VectorX<S> nearest = edge_distances<S>(mesh, positions, several);
    CHECK(nearest(2) == S(1));
    CHECK(nearest(1) == S(1));
    CHECK(nearest(5) == S(1));
    CHECK(edge_distances<S>(mesh, positions, std::vector<std::int32_t>{}).minCoeff() ==
          std::numeric_limits<S>::infinity());
}
