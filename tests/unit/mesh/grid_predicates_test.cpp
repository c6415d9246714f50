// SPDX-License-Identifier: MIT
#include <softtissue/mesh/grid_predicates.hpp>

#include <softtissue/element/tet4.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

using namespace softtissue;

namespace {

Vector3<double> random_grid_point(RandomGenerator& random, double size) {
    Vector3<double> p;
    for (int i = 0; i < 3; ++i) {
        p(i) = std::floor(random.uniform(0, size));
    }
    return p;
}

}  // namespace

TEST_CASE_TEMPLATE("the grid holds positions to half its unit", S, float, double) {
    RandomGenerator random(1);
    Matrix3X<S> positions(3, 100);
    for (Index i = 0; i < positions.size(); ++i) {
        positions(i) = S(random.uniform(-0.7, 1.3));
    }
    const Matrix3X<double> grid = to_grid(positions);
    CHECK(grid.minCoeff() == 0);
    CHECK(grid.maxCoeff() == 0x1p24);
    CHECK((grid.array() == grid.array().round()).all());
    const Vector3<double> corner = positions.template cast<double>().rowwise().minCoeff();
    const Matrix3X<double> shifted = positions.template cast<double>().colwise() - corner;
    const double unit = shifted.maxCoeff() / 0x1p24;
    CHECK((shifted - unit * grid).cwiseAbs().maxCoeff() <= 0.5 * unit * (1 + 1e-6));

    positions(1, 7) = std::numeric_limits<S>::quiet_NaN();
    CHECK_THROWS_WITH_AS(to_grid(positions), "grid: position of vertex 7 is not finite", InvalidInput);
}

TEST_CASE("orientation is that of Tet4 and exact next to a plane") {
    const Vector3<double> o(0, 0, 0);
    const Vector3<double> x(1, 0, 0);
    const Vector3<double> y(0, 1, 0);
    const Vector3<double> z(0, 0, 1);
    Tet4::Nodes<double> tet;
    tet << o, x, y, z;
    REQUIRE(Tet4::rest_volume(tet) > 0);
    CHECK(orientation(o, x, y, z) == 1);
    CHECK(orientation(x, o, y, z) == -1);
    CHECK(orientation(o, x, y, Vector3<double>(1, 1, 0)) == 0);

    // Points a + i u + j v of a lattice plane: flat to the bit; one step across the plane decides.
    RandomGenerator random(2);
    int undecided_by_rounding = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Vector3<double> a = random_grid_point(random, 0x1p22);
        const Vector3<double> u = random_grid_point(random, 0x1p20);
        const Vector3<double> v = random_grid_point(random, 0x1p20);
        const Vector3<double> b = a + u;
        const Vector3<double> c = a + v;
        const Vector3<double> d = a + 3 * u + 5 * v;
        CHECK(orientation(a, b, c, d) == 0);
        const Vector3<double> normal = u.cross(v);
        Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        const Vector3<double> across = d + Vector3<double>::Unit(axis);
        const int expected = normal(axis) > 0 ? 1 : -1;
        CHECK(orientation(a, b, c, across) == expected);
        CHECK(orientation(b, a, c, across) == -expected);
        undecided_by_rounding += normal.dot(d - a) != 0 ? 1 : 0;
    }
    CHECK(undecided_by_rounding > 0);  // or the exact branch would not have been needed
}

TEST_CASE("the side of a sphere is exact on it and next to it") {
    const Vector3<double> o(0, 0, 0);
    const Vector3<double> x(4, 0, 0);
    const Vector3<double> y(0, 4, 0);
    const Vector3<double> z(0, 0, 4);
    CHECK(sphere_side(o, x, y, z, Vector3<double>(1, 1, 1)) == 1);
    CHECK(sphere_side(o, x, y, z, Vector3<double>(5, 5, 5)) == -1);
    CHECK(sphere_side(o, x, y, z, Vector3<double>(4, 4, 4)) == 0);

    // Reflections of one offset lie on one sphere around the centre.
    RandomGenerator random(3);
    for (int trial = 0; trial < 2000; ++trial) {
        const Vector3<double> centre = random_grid_point(random, 0x1p23) + Vector3<double>::Constant(0x1p22);
        const Vector3<double> r = random_grid_point(random, 0x1p22) + Vector3<double>::Ones();
        const auto at = [&](double sx, double sy, double sz) {
            return Vector3<double>(centre + Vector3<double>(sx * r(0), sy * r(1), sz * r(2)));
        };
        std::array<Vector3<double>, 4> v{at(1, 1, 1), at(-1, -1, 1), at(-1, 1, -1), at(1, -1, -1)};
        if (orientation(v[0], v[1], v[2], v[3]) < 0) {
            std::swap(v[0], v[1]);
        }
        const Vector3<double> p = at(-1, 1, 1);
        CHECK(sphere_side(v[0], v[1], v[2], v[3], p) == 0);
        CHECK(sphere_side(v[0], v[1], v[2], v[3], p - Vector3<double>::UnitY()) == 1);
        CHECK(sphere_side(v[0], v[1], v[2], v[3], p + Vector3<double>::UnitY()) == -1);
        CHECK(sphere_side(v[1], v[2], v[0], v[3], p + Vector3<double>::UnitY()) == -1);
    }
}
