// SPDX-License-Identifier: MIT
#include <softtissue/model/surface_mesh.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("SurfaceMesh: the normal has twice the area and follows the corners' order") {
    SurfaceMesh mesh;
    mesh.vertices = {{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 3.0, 0.0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
    CHECK(mesh.normal(0) == Vector3<double>(0.0, 0.0, 6.0));
    CHECK(mesh.normal(1) == Vector3<double>(0.0, 0.0, -6.0));
}
