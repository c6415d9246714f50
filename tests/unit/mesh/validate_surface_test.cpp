// SPDX-License-Identifier: MIT
#include <softtissue/mesh/validate_surface.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace softtissue;

namespace {

template <class S>
struct Surface {
    Matrix3X<S> positions;
    Triangles triangles;

    void validate() const { validate_closed_surface(positions, triangles, "body.obj"); }
};

template <class S>
Surface<S> octahedron(S centre = S(0), std::int32_t first = 0) {
    Surface<S> surface{Matrix3X<S>(3, 6), Triangles(3, 8)};
    surface.positions << 1, -1, 0, 0, 0, 0,  //
        0, 0, 1, -1, 0, 0,                   //
        0, 0, 0, 0, 1, -1;
    surface.positions.row(0).array() += centre;
    surface.triangles << 0, 2, 1, 3, 2, 1, 3, 0,  //
        2, 1, 3, 0, 0, 2, 1, 3,                   //
        4, 4, 4, 4, 5, 5, 5, 5;
    surface.triangles.array() += first;
    return surface;
}

template <class S>
Surface<S> joined(const Surface<S>& a, const Surface<S>& b) {
    Surface<S> both{Matrix3X<S>(3, a.positions.cols() + b.positions.cols()),
                    Triangles(3, a.triangles.cols() + b.triangles.cols())};
    both.positions << a.positions, b.positions;
    both.triangles << a.triangles, b.triangles;
    return both;
}

}  // namespace

TEST_CASE_TEMPLATE("closed outward surfaces pass, of one or two pieces", S, float, double) {
    CHECK_NOTHROW(octahedron<S>().validate());
    CHECK_NOTHROW(joined(octahedron<S>(), octahedron<S>(S(5), 6)).validate());
}

TEST_CASE_TEMPLATE("each defect is refused by name", S, float, double) {
    Surface<S> surface = octahedron<S>();
    SUBCASE("not finite") {
        surface.positions(1, 3) = std::numeric_limits<S>::quiet_NaN();
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: position of vertex 3 is not finite", InvalidInput);
    }
    SUBCASE("no triangles") {
        surface.triangles.resize(3, 0);
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: no triangles, expected a closed surface", InvalidInput);
    }
    SUBCASE("index out of range") {
        surface.triangles(2, 1) = 6;
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: triangle 1 uses vertex 6, expected 0 to 5", InvalidInput);
    }
    SUBCASE("open edge") {
        surface.triangles = surface.triangles.leftCols(7).eval();
        CHECK_THROWS_WITH_AS(surface.validate(),
                             "body.obj: edge (3, 0) belongs to triangle 3 only, expected a closed surface",
                             InvalidInput);
    }
    SUBCASE("inconsistent orientation") {
        surface.triangles.col(0).reverseInPlace();
        CHECK_THROWS_AS(surface.validate(), InvalidInput);
    }
    SUBCASE("non-manifold vertex") {
        surface = joined(surface, octahedron<S>(S(2), 6));
        surface.triangles = (surface.triangles.array() == 7).select(0, surface.triangles).eval();
        surface.positions.col(7) = surface.positions.col(11);
        surface.triangles = (surface.triangles.array() == 11).select(7, surface.triangles).eval();
        surface.positions.conservativeResize(3, 11);
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: several fans of triangles meet at vertex 0, expected one",
                             InvalidInput);
    }
    SUBCASE("vertex in no triangle") {
        surface.positions.conservativeResize(3, 7);
        surface.positions.col(6).setZero();
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: vertex 6 is in no triangle", InvalidInput);
    }
    SUBCASE("triangle without area") {
        surface.positions.col(4) = surface.positions.col(0);
        CHECK_THROWS_WITH_AS(surface.validate(), "body.obj: triangle 0 has area 0, expected > 0", InvalidInput);
    }
    SUBCASE("inwards") {
        surface.triangles.row(0).swap(surface.triangles.row(1));
        try {
            surface.validate();
            FAIL("accepted");
        } catch (const InvalidInput& error) {
            CHECK(std::string(error.what()).find("expected > 0 (the triangles face inwards)") != std::string::npos);
        }
    }
}
