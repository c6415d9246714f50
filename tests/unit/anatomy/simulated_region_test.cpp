// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/simulated_region.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("the region keeps what is outside the extremities, numbered anew", S, float, double) {
    const CapsuleBody<S> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    RegionOptions options;
    options.extremities = JointGroups{{0}, {2}};
    const auto region = make_simulated_region(body.positions, mesh, body.weights, options);

    REQUIRE(region.loops.size() == 2);
    CHECK(region.loops[0].size() == size_t(body.num_sectors));
    Index kept = 0;
    for (Index v = 0; v < body.positions.cols(); ++v) {
        const bool is_middle = body.weights.row(v)[0].joint == 1;
        CHECK((region.region_vertices[size_t(v)] >= 0) == is_middle);
        kept += is_middle ? 1 : 0;
    }
    CHECK(region.num_vertices() == kept);
    CHECK(std::is_sorted(region.body_vertices.begin(), region.body_vertices.end()));
    for (Index i = 0; i < region.num_vertices(); ++i) {
        CHECK(region.region_vertices[size_t(region.body_vertices[size_t(i)])] == i);
    }
    for (Index t = 0; t < region.num_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) {
            CHECK(region.body_vertices[size_t(region.triangles(k, t))] ==
                  body.faces(k, region.body_triangles[size_t(t)]));
        }
    }
    for (const auto& loop : region.loops) {
        for (const std::int32_t v : loop) {
            CHECK(region.is_rim(v));
        }
    }
    // Rings are 0.03 m apart: the middle one is half way between the cuts.
    const S half =
        (region.gather(body.positions).row(1).maxCoeff() - region.gather(body.positions).row(1).minCoeff()) / S(2);
    CHECK(region.cut_distance.maxCoeff() == doctest::Approx(double(half)).epsilon(1e-5));
}

TEST_CASE("without extremities the whole body stays, without a cut") {
    const CapsuleBody<double> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    RegionOptions options;
    options.extremities = JointGroups{};
    const auto region = make_simulated_region(body.positions, mesh, body.weights, options);
    CHECK(region.triangles == body.faces);
    CHECK(region.loops.empty());
    CHECK(std::isinf(region.cut_distance.minCoeff()));
}

TEST_CASE("a vertex left out makes a cut of its own; ears and pinches go") {
    const CapsuleBody<double> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    RegionOptions options;
    options.extremities = JointGroups{};
    const std::int32_t hole = body.vertex(10, 3);
    options.excluded_vertices = {hole};
    auto region = make_simulated_region(body.positions, mesh, body.weights, options);
    CHECK(region.num_vertices() == body.positions.cols() - 1);
    REQUIRE(region.loops.size() == 1);
    CHECK(region.loops[0].size() == 6);

    // The neighbour after next: the two holes would touch in a vertex, or leave an ear between them.
    for (const std::int32_t other : {body.vertex(10, 5), body.vertex(12, 5), body.vertex(12, 3)}) {
        options.excluded_vertices = {hole, other};
        region = make_simulated_region(body.positions, mesh, body.weights, options);
        const TriangleMesh cut(region.triangles, region.num_vertices());
        std::vector<int> boundary_edges(size_t(region.num_triangles()), 0);
        for (const TriangleMesh::Edge& edge : cut.edges()) {
            boundary_edges[size_t(edge.triangles[0])] += edge.is_boundary() ? 1 : 0;
        }
        CHECK(*std::max_element(boundary_edges.begin(), boundary_edges.end()) == 1);
        CHECK_NOTHROW(static_cast<void>(cut.boundary_loops()));
    }
}

TEST_CASE("of several pieces the largest stays") {
    const CapsuleBody<double> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    RegionOptions options;
    options.extremities = JointGroups{};
    for (std::int32_t k = 0; k < body.num_sectors; ++k) {
        options.excluded_vertices.push_back(body.vertex(20, k));
    }
    const auto region = make_simulated_region(body.positions, mesh, body.weights, options);
    CHECK(region.num_vertices() == 20 * body.num_sectors + 1);
    CHECK(region.gather(body.positions).row(1).maxCoeff() < body.height(20));
}

TEST_CASE("what cannot be cut is refused") {
    const CapsuleBody<double> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    const auto make = [&](const RegionOptions& options) {
        return make_simulated_region(body.positions, mesh, body.weights, options).num_vertices();
    };
    CHECK_THROWS_WITH_AS(make({}),
                         "simulated region: the body has 3 joints, expected SMPL's 24 (SMPL-H: 52, SMPL-X: 55), or the "
                         "joints of its extremities "
                         "named in the options",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(make({.extremities = JointGroups{{1, 3}}}),
                         "simulated region: extremity joint 3, expected 0 to 2", InvalidInput);
    CHECK_THROWS_WITH_AS(make({.extremities = JointGroups{}, .excluded_vertices = {-1}}),
                         "simulated region: excluded vertex -1, expected 0 to 497", InvalidInput);
    CHECK_THROWS_WITH_AS(make({.extremities = JointGroups{{0, 1, 2}}}),
                         "simulated region: no triangle left, expected skin outside the extremities", InvalidInput);
}

TEST_CASE("fingers, jaw and eyes of SMPL's relatives belong to their extremities") {
    CHECK(smpl_extremities() == JointGroups{{15}, {7, 8, 10, 11}, {20, 21, 22, 23}});
    const JointGroups hands = smpl_extremities(52);
    CHECK(hands[0] == std::vector<std::int32_t>{15});
    CHECK(hands[2].size() == 32);
    CHECK(hands[2].back() == 51);
    const JointGroups expressive = smpl_extremities(55);
    CHECK(expressive[0] == std::vector<std::int32_t>{15, 22, 23, 24});
    CHECK(expressive[2].size() == 32);
    CHECK(expressive[2][2] == 25);
    CHECK(expressive[2].back() == 54);
}
