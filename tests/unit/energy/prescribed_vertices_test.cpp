// SPDX-License-Identifier: MIT
#include <softtissue/energy/prescribed_vertices.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace softtissue;

TEST_CASE("free vertices are numbered in mesh order") {
    const std::array<std::int32_t, 2> held{3, 1};
    const PrescribedVertices vertices(5, held);
    CHECK(vertices.num_vertices() == 5);
    CHECK(vertices.num_free() == 3);
    CHECK(vertices.free_vertices() == std::vector<std::int32_t>{0, 2, 4});
    CHECK(vertices.is_prescribed(1));
    CHECK(vertices.is_prescribed(3));
    CHECK_FALSE(vertices.is_prescribed(0));
    CHECK(vertices.free_index(0) == 0);
    CHECK(vertices.free_index(1) == PrescribedVertices::prescribed);
    CHECK(vertices.free_index(4) == 2);
}

TEST_CASE_TEMPLATE("restrict and add touch the free columns only", Scalar, float, double) {
    const std::array<std::int32_t, 1> held{1};
    const PrescribedVertices vertices(3, held);
    Matrix3X<Scalar> full(3, 3);
    full << 1, 4, 7, 2, 5, 8, 3, 6, 9;
    VectorX<Scalar> free;
    vertices.restrict_into(full, free);
    REQUIRE(free.size() == 6);
    CHECK(free.template head<3>() == full.col(0));
    CHECK(free.template tail<3>() == full.col(2));
    Matrix3X<Scalar> expected = full;
    expected.col(0) *= Scalar(1.5);
    expected.col(2) *= Scalar(1.5);
    vertices.add_into(free, Scalar(0.5), full);
    CHECK(full == expected);
}

TEST_CASE("none and all prescribed") {
    CHECK(PrescribedVertices(3, {}).num_free() == 3);
    const std::array<std::int32_t, 2> all{0, 1};
    CHECK(PrescribedVertices(2, all).num_free() == 0);
    CHECK(PrescribedVertices(0, {}).num_vertices() == 0);
}

TEST_CASE("a vertex out of range or named twice is refused") {
    const std::array<std::int32_t, 2> too_large{0, 4}, negative{-1, 2}, twice{2, 2};
    CHECK_THROWS_WITH_AS(PrescribedVertices(4, too_large), "prescribed vertex 4, expected 0 to 3", InvalidInput);
    CHECK_THROWS_WITH_AS(PrescribedVertices(4, negative), "prescribed vertex -1, expected 0 to 3", InvalidInput);
    CHECK_THROWS_WITH_AS(PrescribedVertices(4, twice), "prescribed vertex 2 is named twice", InvalidInput);
}
