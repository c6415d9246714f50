// SPDX-License-Identifier: MIT
#include <softtissue/core/checked_index.hpp>

#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/mesh/prism_layers.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using softtissue_test::refusal;

static constexpr Index too_many = Index(1) << 31;

TEST_CASE("a count becomes a 32-bit index as long as it fits") {
    CHECK(checked_index(0, "vertices") == 0);
    CHECK(checked_index(largest_index, "vertices") == 2147483647);
    CHECK(refusal([] { checked_index(too_many, "vertices"); }) ==
          "vertices = 2147483648, expected 0 to 2147483647 (indices are 32-bit)");
    CHECK(refusal([] { checked_index(-1, "layer ", 7, ": vertices"); }) ==
          "layer 7: vertices = -1, expected 0 to 2147483647 (indices are 32-bit)");
    CHECK_THROWS_AS(checked_index(too_many * 1000, "vertices"), InvalidInput);
}

TEST_CASE("what numbers more than 32 bits hold is refused before memory is asked for") {
    CHECK(refusal([] { PrescribedVertices(too_many, {}); }).find("vertices of the mesh = 2147483648") !=
          std::string::npos);
    CHECK(refusal([] { TriangleMesh(Triangles(3, 0), too_many, "skin"); }).find("skin: vertices = 2147483648") == 0);
    const Triangles two = (Triangles(3, 2) << 0, 0, 1, 1, 2, 2).finished();
    CHECK(refusal([&] {
              (void)PrismLayers{.num_columns = too_many / 2, .num_layers = 1}.prisms(two);
          }).find("vertices") != std::string::npos);
    CHECK(refusal([&] {
              (void)PrismLayers{.num_columns = 1, .num_layers = too_many / 2}.prisms(two);
          }).find("prisms") != std::string::npos);
    CHECK(refusal([] { BlockMatrix<double>::require_size(too_many / 3 + 1, 1); }).find("rows") != std::string::npos);
    CHECK(refusal([] { BlockMatrix<double>::require_size(1000, too_many / 9 + 1); }).find("entries") !=
          std::string::npos);
    CHECK_NOTHROW(BlockMatrix<double>::require_size(largest_index / 3, largest_index / 9));
}
