// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_welding.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;
using namespace io_test;

namespace {

GltfSurface read_bar(const TemporaryFolder& folder) {
    rigged_bar().write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    return read_gltf_surface(document, document.element("meshes", 0), 3);
}

/// Each vertex once more, half of the triangles at the second ones.
GltfSurface twice(const GltfSurface& bar) {
    GltfSurface doubled = bar;
    doubled.positions.resize(3, 32);
    doubled.positions << bar.positions, bar.positions;
    doubled.positions = doubled.positions.unaryExpr([](double x) { return x == 0.0 ? -0.0 : x; }).eval();
    doubled.triangles.rightCols(14).array() += 16;
    doubled.weights.insert(doubled.weights.end(), bar.weights.begin(), bar.weights.end());
    doubled.morph_targets[0].resize(3, 32);
    doubled.morph_targets[0] << bar.morph_targets[0], bar.morph_targets[0];
    return doubled;
}

}  // namespace

TEST_CASE("vertices at one place become one") {
    const TemporaryFolder folder;
    const GltfSurface bar = read_bar(folder);
    GltfSurface doubled = twice(bar);
    doubled.triangles.col(0) = Eigen::Vector3i(1, 17, 2);  // two corners at one place
    const GltfSurface welded = welded_surface(doubled, "x");
    CHECK(welded.positions == bar.positions);
    CHECK(welded.morph_targets[0] == bar.morph_targets[0]);
    CHECK(welded.repairs.lost_triangles == 1);
    CHECK(welded.repairs.averaged_places == 0);
    CHECK(welded.weights[5][1].weight == bar.weights[5][1].weight);
    CHECK(welded.triangles == bar.triangles.rightCols(27));
    CHECK(welded.welded_vertex[20] == 4);
    GltfSurface point = bar;
    point.positions.setZero();
    point.weights.assign(16, {{0, 1.0}});
    CHECK(contains(refusal([&] { welded_surface(point, "x"); }),
                   "x: all 28 triangles have two corners at one place, expected a surface"));
}

TEST_CASE("vertices at one place with different weights get the mean, and are counted") {
    const TemporaryFolder folder;
    GltfSurface doubled = twice(read_bar(folder));
    doubled.weights[4] = {{0, 0.5}, {1, 0.5}};
    doubled.weights[20] = {{1, 0.25}, {2, 0.75}};
    const GltfSurface welded = welded_surface(doubled, "x");
    CHECK(welded.repairs.averaged_places == 1);
    CHECK(welded.repairs.largest_weight_difference == 0.75);
    REQUIRE(welded.weights[4].size() == 3);
    CHECK(welded.weights[4][0].weight == 0.25);
    CHECK(welded.weights[4][1].weight == 0.375);
    CHECK(welded.weights[4][2].weight == 0.375);
    CHECK(welded.weights[4][2].joint == 2);
}
