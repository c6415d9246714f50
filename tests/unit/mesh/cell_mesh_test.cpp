// SPDX-License-Identifier: MIT
#include <softtissue/mesh/cell_mesh.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// Two tets on a common triangle.
CellMesh<Tet4, double> two_tets() {
    CellMesh<Tet4, double> mesh{Matrix3X<double>(3, 5), Connectivity<4>(4, 2)};
    mesh.rest_positions << 0, 1, 0, 0, 1,  //
        0, 0, 1, 0, 1,                     //
        0, 0, 0, 1, 1;
    mesh.cells << 0, 1,  //
        1, 2,            //
        2, 3,            //
        3, 4;
    return mesh;
}

}  // namespace

TEST_CASE("counts, nodes of a cell, and a mesh that is accepted") {
    const CellMesh<Tet4, double> mesh = two_tets();
    CHECK(mesh.num_vertices() == 5);
    CHECK(mesh.num_cells() == 2);
    CHECK(mesh.rest_nodes(1).col(3) == mesh.rest_positions.col(4));
    CHECK_NOTHROW(mesh.validate());
}

TEST_CASE("inverted cells are counted at current positions") {
    const CellMesh<Tet4, double> mesh = two_tets();
    Matrix3X<double> x = mesh.rest_positions;
    CHECK(mesh.count_inverted(x) == 0);
    x.col(4).setConstant(0.1);  // through the common triangle x + y + z = 1
    CHECK(mesh.count_inverted(x) == 1);
    x = -x;
    CHECK(mesh.count_inverted(x) == 1);
}

TEST_CASE("a mesh that cannot be worked with is refused by name, cell and value") {
    CellMesh<Tet4, double> mesh = two_tets();
    SUBCASE("index out of range") {
        mesh.cells(2, 1) = 5;
        CHECK_THROWS_WITH_AS(mesh.validate(), "mesh: cell 1, node 2 is vertex 5, expected 0 to 4", InvalidInput);
    }
    SUBCASE("negative index") {
        mesh.cells(0, 0) = -1;
        CHECK_THROWS_WITH_AS(mesh.validate(), "mesh: cell 0, node 0 is vertex -1, expected 0 to 4", InvalidInput);
    }
    SUBCASE("repeated vertex") {
        mesh.cells(3, 0) = 1;
        CHECK_THROWS_WITH_AS(mesh.validate(), "mesh: cell 0 uses vertex 1 twice", InvalidInput);
    }
    SUBCASE("not finite") {
        mesh.rest_positions(1, 3) = std::numeric_limits<double>::quiet_NaN();
        CHECK_THROWS_WITH_AS(mesh.validate(), "mesh: rest position of vertex 3 is not finite", InvalidInput);
    }
    SUBCASE("inverted cell") {
        mesh.cells.col(0).head<2>().reverseInPlace();
        CHECK_THROWS_WITH_AS(mesh.validate(),
                             "mesh: cell 0 has a rest Jacobian bound of -1, expected > 0 (inverted or degenerate cell, "
                             "or nodes in the wrong order)",
                             InvalidInput);
    }
}

TEST_CASE("a prism with its triangles exchanged is refused") {
    CellMesh<Prism6, float> mesh{Matrix3X<float>(3, 6), Connectivity<6>(6, 1)};
    mesh.rest_positions << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,                     //
        0, 0, 0, 1, 1, 1;
    mesh.cells << 0, 1, 2, 3, 4, 5;
    CHECK_NOTHROW(mesh.validate());
    mesh.cells << 3, 4, 5, 0, 1, 2;
    CHECK_THROWS_AS(mesh.validate(), InvalidInput);
}
