// SPDX-License-Identifier: MIT
#include <softtissue/mesh/inside_surface.hpp>

#include <softtissue/testing/random_states.hpp>

#include "../anatomy/capsule_body.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace softtissue;

TEST_CASE_TEMPLATE("inside a capsule, apart from its facets, is where its axis is near", S, float, double) {
    const CapsuleBody<S> body;
    const InsideSurface<S> inside(body.positions, body.faces);
    RandomGenerator random(1);
    int num_inside = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const Vector3<S> p(S(random.uniform(-0.15, 0.15)), S(random.uniform(-0.1, 1.1)),
                           S(random.uniform(-0.15, 0.15)));
        const Vector3<S> axis(S(0), std::clamp(p(1), S(0.1), S(0.9)), S(0));
        const S distance = (p - axis).norm();
        // The facets of 16 sectors and the steep rings at the poles cut off at most a fifth of the radius.
        if (distance < S(0.08)) {
            ++num_inside;
            CHECK(inside.winding_number(p) == 1);
        } else if (distance > S(0.1)) {
            CHECK(inside.winding_number(p) == 0);
            CHECK(!inside.contains(p));
        }
    }
    CHECK(num_inside > 500);
    // Rays through the poles, where 16 triangles meet, and through edges of the rings.
    CHECK(inside.contains(Vector3<S>(S(0), S(0.5), S(0))));
    CHECK(inside.contains(Vector3<S>(body.positions(0, 5) / S(2), S(0.05), body.positions(2, 5) / S(2))));
}

TEST_CASE("nested surfaces are counted with their orientation") {
    const CapsuleBody<double> body;
    const Index n = body.positions.cols();
    const Index m = body.faces.cols();
    Matrix3X<double> positions(3, 2 * n);
    positions << body.positions, 0.5 * body.positions;
    positions.rightCols(n).row(1).array() += 0.25;
    Triangles triangles(3, 2 * m);
    triangles << body.faces, (body.faces.array() + std::int32_t(n)).matrix();
    const Vector3<double> middle(0.01, 0.5, 0.007);
    CHECK(InsideSurface<double>(positions, triangles).winding_number(middle) == 2);
    triangles.rightCols(m).row(0).swap(triangles.rightCols(m).row(1));  // a cavity
    const InsideSurface<double> hollow(positions, triangles);
    CHECK(hollow.winding_number(middle) == 0);
    CHECK(hollow.winding_number(Vector3<double>(0.08, 0.5, 0.0)) == 1);
}

TEST_CASE("an open surface is refused") {
    const CapsuleBody<double> body;
    const Triangles open = body.faces.leftCols(body.faces.cols() - 1);
    CHECK_THROWS_AS(InsideSurface<double>(body.positions, open), InvalidInput);
}
