// SPDX-License-Identifier: MIT
#include <softtissue/mesh/crossing_triangles.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

Triangles separate_triangles(Index count) {
    Triangles triangles(3, count);
    for (Index t = 0; t < count; ++t) {
        triangles.col(t) << std::int32_t(3 * t), std::int32_t(3 * t + 1), std::int32_t(3 * t + 2);
    }
    return triangles;
}

}  // namespace

TEST_CASE_TEMPLATE("a triangle through another crosses, one beside or touching does not", S, float, double) {
    Matrix3X<S> positions(3, 6);
    positions << 0, 2, 0, S(0.5), S(0.5), S(0.5),  //
        0, 0, 2, S(0.5), S(0.5), 3,                //
        0, 0, 0, -1, 1, 0;
    const Triangles triangles = separate_triangles(2);
    CHECK(crossing_triangles(positions, triangles) == Pairs{{0, 1}});

    Matrix3X<S> beside = positions;
    beside.rightCols(3).row(0).array() += S(3);
    CHECK(crossing_triangles(beside, triangles).empty());

    Matrix3X<S> touching = positions;
    touching.col(3)(2) = S(0);
    touching.col(5) << S(0.5), S(0.5), S(1);
    CHECK(crossing_triangles(touching, triangles).empty());

    Triangles sharing = triangles;
    sharing(0, 1) = 0;
    CHECK(crossing_triangles(positions, sharing).empty());
    CHECK(crossing_triangles(positions, Triangles(3, 0)).empty());
}

TEST_CASE("the tree finds what comparing all pairs finds") {
    RandomGenerator random(7);
    const Index count = 200;
    Matrix3X<double> positions(3, 3 * count);
    for (Index t = 0; t < count; ++t) {
        const double size = random.uniform() < 0.1 ? 1.0 : 0.15;  // a few much larger than the others
        const Vector3<double> centre(random.uniform(), random.uniform(), random.uniform());
        for (Index k = 0; k < 3; ++k) {
            const Vector3<double> offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            positions.col(3 * t + k) = centre + size * offset;
        }
    }
    const Triangles triangles = separate_triangles(count);
    Pairs all;
    for (std::int32_t s = 0; s < count; ++s) {
        for (std::int32_t t = s + 1; t < count; ++t) {
            Matrix3X<double> two(3, 6);
            two << positions.middleCols(3 * s, 3), positions.middleCols(3 * t, 3);
            if (!crossing_triangles(two, separate_triangles(2)).empty()) {
                all.emplace_back(s, t);
            }
        }
    }
    CHECK(all.size() > 50);
    CHECK(crossing_triangles(positions, triangles) == all);
}

TEST_CASE_TEMPLATE("between two surfaces their own vertices do not matter", S, float, double) {
    Matrix3X<S> first(3, 3);
    first << 0, 2, 0,  //
        0, 0, 2,       //
        0, 0, 0;
    Matrix3X<S> second(3, 6);
    second << 5, 5, 6, S(0.5), S(0.5), S(0.5),  //
        5, 6, 5, S(0.5), S(0.5), 3,             //
        0, 0, 0, -1, 1, 0;
    CHECK(crossing_triangles(first, separate_triangles(1), second, separate_triangles(2)) == Pairs{{0, 1}});
    CHECK(crossing_triangles(second, separate_triangles(2), first, separate_triangles(1)) == Pairs{{1, 0}});
    CHECK(crossing_triangles(first, separate_triangles(1), first, separate_triangles(1)).empty());  // coplanar
    CHECK(crossing_triangles(first, Triangles(3, 0), second, separate_triangles(2)).empty());
}

TEST_CASE("two surfaces cross where the two in one array do") {
    RandomGenerator random(8);
    const Index count = 150;
    Matrix3X<double> positions = Matrix3X<double>::NullaryExpr(3, 6 * count, [&random] { return random.uniform(); });
    for (Index t = 0; t < 2 * count; ++t) {
        const Vector3<double> corner = positions.col(3 * t);
        positions.middleCols(3 * t, 3) = (0.75 * corner).replicate(1, 3) + 0.25 * positions.middleCols(3 * t, 3);
    }
    Pairs across;
    for (const auto& [s, t] : crossing_triangles(positions, separate_triangles(2 * count))) {
        if (s < count && t >= count) {
            across.emplace_back(s, std::int32_t(t - count));
        }
    }
    CHECK(across.size() > 50);
    const Matrix3X<double> first = positions.leftCols(3 * count);
    const Matrix3X<double> second = positions.rightCols(3 * count);
    CHECK(crossing_triangles(first, separate_triangles(count), second, separate_triangles(count)) == across);
}

TEST_CASE("corners that are not finite are refused") {
    Matrix3X<double> positions = Matrix3X<double>::Zero(3, 6);
    positions(1, 4) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(crossing_triangles(positions, separate_triangles(2)),
                         "triangle 1: position of vertex 4 is not finite", InvalidInput);
}
