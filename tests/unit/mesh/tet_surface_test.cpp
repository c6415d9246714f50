// SPDX-License-Identifier: MIT
#include <softtissue/mesh/tet_surface.hpp>

#include <softtissue/mesh/validate_surface.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("faces that two cells share are inside, the others look out") {
    Matrix3X<double> x(3, 5);
    x << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1;
    Connectivity<4> tets(4, 1);
    tets << 0, 1, 2, 3;
    CHECK(surface_of_tets(tets) == (Triangles(3, 4) << 1, 0, 0, 0, 2, 3, 1, 2, 3, 2, 3, 1).finished());
    validate_closed_surface<double>(x.leftCols(4), surface_of_tets(tets), "tet");
    tets.resize(4, 2);
    tets << 0, 1, 1, 2, 2, 3, 3, 4;  // the second beyond the face 1 2 3
    const Triangles surface = surface_of_tets(tets);
    CHECK(surface.cols() == 6);
    validate_closed_surface<double>(x, surface, "two tets");
    CHECK(surface_of_tets(Connectivity<4>(4, 0)).cols() == 0);
}
