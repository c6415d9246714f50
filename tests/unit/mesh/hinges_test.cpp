// SPDX-License-Identifier: MIT
#include <softtissue/mesh/hinges.hpp>

#include <doctest/doctest.h>

#include <set>

using namespace softtissue;

TEST_CASE("a hinge starts with its first triangle and ends with the vertex opposite") {
    Triangles two(3, 2);
    two << 7, 5, 5, 7, 2, 9;  // (7, 5, 2) and (5, 7, 9): vertices of a larger mesh
    const Connectivity<4> hinges = interior_hinges(TriangleMesh(two, 12));
    REQUIRE(hinges.cols() == 1);
    CHECK(hinges(0, 0) == 7);
    CHECK(hinges(1, 0) == 5);
    CHECK(hinges(2, 0) == 2);
    CHECK(hinges(3, 0) == 9);
}

TEST_CASE("every edge of a closed surface is a hinge, and each names two triangles of the surface") {
    Triangles tetrahedron(3, 4);
    tetrahedron << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
    const TriangleMesh surface(tetrahedron, 4);
    const Connectivity<4> hinges = interior_hinges(surface);
    REQUIRE(hinges.cols() == 6);
    const auto is_triangle = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        for (Index t = 0; t < 4; ++t) {
            for (int k = 0; k < 3; ++k) {
                if (tetrahedron(k, t) == a && tetrahedron((k + 1) % 3, t) == b && tetrahedron((k + 2) % 3, t) == c) {
                    return true;
                }
            }
        }
        return false;
    };
    std::set<std::set<std::int32_t>> edges;
    for (Index h = 0; h < 6; ++h) {
        CHECK(is_triangle(hinges(0, h), hinges(1, h), hinges(2, h)));
        CHECK(is_triangle(hinges(1, h), hinges(0, h), hinges(3, h)));
        edges.insert({hinges(0, h), hinges(1, h)});
    }
    CHECK(edges.size() == 6);
}

TEST_CASE("a single triangle has none") {
    Triangles one(3, 1);
    one << 0, 1, 2;
    CHECK(interior_hinges(TriangleMesh(one, 3)).cols() == 0);
}
