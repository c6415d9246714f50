// SPDX-License-Identifier: MIT
#include <softtissue/mesh/prism_layers.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("columns lie side by side, prisms stand on lower levels") {
    const PrismLayers layers{4, 2};
    CHECK(layers.num_vertices() == 12);
    CHECK(layers.vertex(3, 1) == 10);
    CHECK(layers.column(10) == 3);
    CHECK(layers.level(10) == 1);
    Triangles triangles(3, 2);
    triangles << 0, 2, 1, 1, 2, 3;
    const Connectivity<6> prisms = layers.prisms(triangles);
    REQUIRE(prisms.cols() == 4);
    Connectivity<6> expected(6, 4);
    expected << 0, 1, 6, 7, 3, 4, 3, 4, 6, 7, 9, 10, 1, 2, 7, 8, 4, 5, 4, 5, 7, 8, 10, 11;
    CHECK(prisms == expected);
}

TEST_CASE_TEMPLATE("an outward triangle gives prisms of positive volume; levels are views", S, float, double) {
    const PrismLayers layers{3, 3};
    CellMesh<Prism6, S> mesh;
    Triangles triangle(3, 1);
    triangle << 0, 1, 2;
    mesh.cells = layers.prisms(triangle);
    mesh.rest_positions.resize(3, layers.num_vertices());
    for (Index i = 0; i < 3; ++i) {
        for (Index level = 0; level < 4; ++level) {
            mesh.rest_positions.col(layers.vertex(i, level)) << S(i == 1), S(i == 2), S(level);
        }
    }
    mesh.validate();
    for (Index c = 0; c < 3; ++c) {
        CHECK(Prism6::rest_volume(mesh.rest_nodes(c)) == doctest::Approx(0.5));
    }
    const Eigen::Ref<const Matrix3X<S>> top = layers.level_positions(mesh.rest_positions, 3);
    CHECK(top.cols() == 3);
    CHECK(top.row(2).minCoeff() == S(3));
    CHECK(top.data() == mesh.rest_positions.data() + 9);  // no copy
}
