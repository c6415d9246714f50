// SPDX-License-Identifier: MIT
#include <softtissue/mesh/triangle_boxes.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("corners and boxes of triangles", S, float, double) {
    Matrix3X<S> positions(3, 4);
    positions << 0, 1, 0, 5,  //
        0, 0, 2, 5,           //
        0, -3, 0, 5;
    Triangles triangles(3, 2);
    triangles << 0, 3,  //
        1, 3,           //
        2, 3;
    CHECK(triangle_corners(positions, triangles, 0) == positions.leftCols(3));
    const std::vector<Box<S>> boxes = triangle_boxes(positions, triangles);
    CHECK(boxes.size() == 2);
    CHECK(boxes[0].min() == Vector3<S>(0, 0, -3));
    CHECK(boxes[0].max() == Vector3<S>(1, 2, 0));
    CHECK(boxes[1].sizes() == Vector3<S>::Zero());

    positions(2, 1) = std::numeric_limits<S>::quiet_NaN();
    CHECK_THROWS_WITH_AS(triangle_boxes(positions, triangles), "triangle 0: position of vertex 1 is not finite",
                         InvalidInput);
    positions(2, 1) = S(0);
    triangles(1, 1) = 4;
    CHECK_THROWS_WITH_AS(triangle_boxes(positions, triangles), "triangle 1 uses vertex 4, expected 0 to 3",
                         InvalidInput);
}
