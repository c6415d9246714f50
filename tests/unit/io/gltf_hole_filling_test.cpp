// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_hole_filling.hpp>
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/mesh/validate_surface.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

/// The bar without the first `left_out` of its 28 triangles, of which two close each end.
GltfSurface open_bar(const TemporaryFolder& folder, Index left_out) {
    rigged_bar().write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    GltfSurface bar = read_gltf_surface(document, document.element("meshes", 0), 3);
    bar.triangles = bar.triangles.rightCols(28 - left_out).eval();
    return bar;
}

}  // namespace

TEST_CASE("a closed surface stays as it is") {
    const TemporaryFolder folder;
    const GltfSurface bar = open_bar(folder, 0), filled = filled_surface(bar, "x");
    CHECK(filled.positions == bar.positions);
    CHECK(filled.triangles == bar.triangles);
    CHECK(filled.hole_centers.empty());
}

TEST_CASE("holes are closed by vertices in their middle, which move with the rim") {
    const TemporaryFolder folder;
    const GltfSurface bar = open_bar(folder, 4);  // both ends
    const GltfSurface filled = filled_surface(bar, "x");
    validate_closed_surface(filled.positions, filled.triangles, "x");
    CHECK(filled.hole_centers == std::vector<std::int32_t>{16, 17});
    CHECK(filled.triangles.cols() == 24 + 8);
    CHECK((filled.positions.col(16) - Vector3<double>(0, 0, 0)).norm() < 1e-7);
    CHECK((filled.positions.col(17) - Vector3<double>(3, 0, 0)).norm() < 1e-7);
    CHECK(filled.morph_targets[0].col(17).norm() < 1e-7);
    REQUIRE(filled.weights[16].size() == 1);
    CHECK(filled.weights[16][0].joint == 0);
    CHECK(filled.weights[17][0].weight == 1.0);
    CHECK(filled.weights[17][0].joint == 1);
}

TEST_CASE("a rim that passes a vertex twice is refused") {
    const TemporaryFolder folder;
    GltfSurface bar = open_bar(folder, 4);
    // both rims through one vertex
    bar.triangles = bar.triangles.unaryExpr([](std::int32_t corner) { return corner == 12 ? 0 : corner; }).eval();
    CHECK(contains(refusal([&] { filled_surface(bar, "x"); }), "boundary passes vertex 0 more than once"));
}

TEST_CASE("the reader fills holes where it is asked to") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    std::vector<std::uint16_t> corners;
    for (int ring = 0; ring < 3; ++ring) {
        for (int k = 0; k < 4; ++k) {
            const int a = 4 * ring + k, b = 4 * ring + (k + 1) % 4;
            for (const int corner : {a, b, a + 4, b, b + 4, a + 4}) {
                corners.push_back(std::uint16_t(corner));
            }
        }
    }
    file.json["meshes"][0]["primitives"][0]["indices"] = file.add(corners, "SCALAR");
    file.write(folder / "a.glb");
    CHECK(read_gltf_character(folder / "a.glb").num_vertices() == 16);
    const GltfCharacter filled = read_gltf_character(folder / "a.glb", {.fill_holes = true});
    CHECK(filled.hole_centers.size() == 2);
    validate_closed_surface(filled.positions, filled.triangles, "a");
    CHECK(filled.weights.num_vertices() == 18);
    CHECK(contains(refusal([&] { read_gltf_character(folder / "a.glb", {.weld = false, .fill_holes = true}); }),
                   "holes are filled in a welded surface only"));
}
