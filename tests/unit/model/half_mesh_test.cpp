// SPDX-License-Identifier: MIT
#include <softtissue/model/half_mesh.hpp>

#include <support/surface_topology.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;
using softtissue_test::surface_topology;

namespace {

/// Hexagon of six triangles around vertex 0; its rim 1..6 is the boundary.
SurfaceMesh hexagon() {
    SurfaceMesh mesh;
    mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {-2, 0, 0}, {-1, -2, 0}, {1, -2, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 1}};
    return mesh;
}

SurfaceMesh octahedron() {
    SurfaceMesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

}  // namespace

TEST_CASE("HalfMesh: finds the boundary, the neighbours and the triangle of a directed edge") {
    const HalfMesh mesh(hexagon());
    CHECK(!mesh.is_on_boundary(0));
    CHECK(mesh.is_on_boundary(3));
    CHECK(mesh.is_boundary_edge(1, 2));
    CHECK(!mesh.is_boundary_edge(0, 2));
    CHECK(mesh.triangle_with(0, 1) == 0);
    CHECK(mesh.triangle_with(1, 0) == 5);
    CHECK(mesh.triangle_with(2, 1) == -1);
    CHECK(mesh.opposite(0, 0, 1) == 2);
    CHECK(mesh.neighbours(0) == std::vector<int>{1, 2, 3, 4, 5, 6});
    CHECK(mesh.neighbours(1) == std::vector<int>{0, 2, 6});
}

TEST_CASE("HalfMesh: splitting an inner and a boundary edge") {
    HalfMesh mesh(hexagon());
    const int inner = mesh.split(0, 1, 0);
    CHECK(mesh.position(inner) == Vector3<double>(1.0, 0.0, 0.0));
    CHECK(!mesh.is_on_boundary(inner));
    CHECK(mesh.star(inner).size() == 4);
    const int rim = mesh.split(3, 4, mesh.triangle_with(3, 4));
    CHECK(mesh.is_on_boundary(rim));
    CHECK(mesh.star(rim).size() == 2);
    const auto topology = surface_topology(mesh.compacted());
    CHECK(topology.bad == 0);
    CHECK(topology.euler() == 1);
    CHECK(topology.boundary == 7);
    CHECK(topology.triangles == 9);
}

TEST_CASE("HalfMesh: collapsing what may be collapsed, refusing what may not") {
    HalfMesh mesh(octahedron());
    const int m = mesh.split(0, 2, 0);
    CHECK(mesh.can_collapse(0, m));
    mesh.collapse(0, m);
    const auto topology = surface_topology(mesh.compacted());
    CHECK(topology.is_closed());
    CHECK(topology.euler() == 2);
    CHECK(topology.triangles == 8);

    // In the hexagon, merging the centre into the rim would join rim vertices by inner edges.
    const HalfMesh rim(hexagon());
    CHECK(!rim.can_collapse(1, 0));
    CHECK(rim.can_collapse(1, 2));

    // A tetrahedron has nothing to give.
    SurfaceMesh small;
    small.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    small.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const HalfMesh tetrahedron(small);
    CHECK(!tetrahedron.can_collapse(0, 1));
}

TEST_CASE("HalfMesh: flipping an edge keeps the surface closed; an existing or a boundary chord is refused") {
    HalfMesh mesh(octahedron());
    // Edge 0-2 between triangles (0, 2, 4) and (2, 0, 5): corners 4 and 5.
    REQUIRE(mesh.can_flip(4, 5));
    mesh.flip(0, mesh.triangle_with(2, 0), 0, 2, 4, 5);
    CHECK(mesh.triangle_with(0, 2) == -1);
    CHECK(mesh.triangle_with(4, 5) + mesh.triangle_with(5, 4) >= 0);
    CHECK(!mesh.can_flip(4, 5));
    const auto topology = surface_topology(mesh.compacted());
    CHECK(topology.is_closed());
    CHECK(topology.euler() == 2);
    CHECK(!HalfMesh(hexagon()).can_flip(1, 3));
}
