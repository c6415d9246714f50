// SPDX-License-Identifier: MIT
#include <softtissue/mesh/triangle_mesh.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

namespace {

Triangles tetrahedron() {
    Triangles triangles(3, 4);
    triangles << 0, 0, 0, 1,  //
        2, 1, 3, 2,           //
        1, 3, 2, 3;
    return triangles;
}

std::vector<std::int32_t> list(std::span<const std::int32_t> row) {
    return {row.begin(), row.end()};
}

}  // namespace

TEST_CASE("a tetrahedron has four triangles, six edges, no boundary") {
    const TriangleMesh mesh(tetrahedron(), 4);
    CHECK(mesh.edges().size() == 6);
    CHECK(mesh.euler_characteristic() == 2);
    CHECK(mesh.is_closed());
    CHECK(mesh.boundary_loops().empty());
    CHECK(list(mesh.neighbours(2)) == std::vector<std::int32_t>{0, 1, 3});
    CHECK(list(mesh.vertex_triangles(3)) == std::vector<std::int32_t>{1, 2, 3});
    for (const TriangleMesh::Edge& edge : mesh.edges()) {
        // The first triangle runs through the edge as the edge is stored, the second the other way.
        for (int side = 0; side < 2; ++side) {
            int found = 0;
            for (int k = 0; k < 3; ++k) {
                const std::int32_t t = edge.triangles[size_t(side)];
                found += mesh.triangles()(k, t) == edge.vertices[size_t(side)] &&
                                 mesh.triangles()((k + 1) % 3, t) == edge.vertices[size_t(1 - side)]
                             ? 1
                             : 0;
            }
            CHECK(found == 1);
        }
    }
}

TEST_CASE("an open surface has loops that run with its triangles") {
    const TriangleMesh mesh(tetrahedron().rightCols(3), 4);
    CHECK(!mesh.is_closed());
    const auto loops = mesh.boundary_loops();
    REQUIRE(loops.size() == 1);
    CHECK(loops[0] == std::vector<std::int32_t>{0, 1, 2});
}

TEST_CASE("two separate triangles have two loops, ascending") {
    Triangles triangles(3, 2);
    triangles << 5, 2, 3, 0, 4, 1;
    const auto loops = TriangleMesh(triangles, 6).boundary_loops();
    REQUIRE(loops.size() == 2);
    CHECK(loops[0] == std::vector<std::int32_t>{0, 1, 2});
    CHECK(loops[1] == std::vector<std::int32_t>{3, 4, 5});
}

TEST_CASE("connectivity that is no oriented surface is refused") {
    Triangles triangles = tetrahedron();
    triangles(1, 2) = 4;
    CHECK_THROWS_WITH_AS(TriangleMesh(triangles, 4, "hand.obj"), "hand.obj: triangle 2 uses vertex 4, expected 0 to 3",
                         InvalidInput);
    triangles(1, 2) = -1;
    CHECK_THROWS_WITH_AS(TriangleMesh(triangles, 4), "surface: triangle 2 uses vertex -1, expected 0 to 3",
                         InvalidInput);
    triangles(1, 2) = 2;
    CHECK_THROWS_WITH_AS(TriangleMesh(triangles, 4), "surface: triangle 2 uses vertex 2 twice", InvalidInput);

    triangles = tetrahedron();
    triangles.col(3) << 1, 3, 2;
    CHECK_THROWS_WITH_AS(
        TriangleMesh(triangles, 4),
        "surface: triangles 0 and 3 run through edge (1, 2) in the same direction, expected consistent orientation",
        InvalidInput);

    Triangles fan(3, 3);
    fan << 0, 1, 0, 1, 0, 1, 2, 3, 4;
    CHECK_THROWS_WITH_AS(TriangleMesh(fan, 5),
                         "surface: edge (0, 1) belongs to triangles 0, 1 and 2, expected at most two", InvalidInput);
}

TEST_CASE("a boundary that passes a vertex twice has no simple loops") {
    Triangles bow(3, 2);
    bow << 0, 0, 1, 3, 2, 4;
    CHECK_THROWS_WITH_AS(static_cast<void>(TriangleMesh(bow, 5).boundary_loops()),
                         "surface: the boundary passes vertex 0 more than once, expected simple loops", InvalidInput);
}
