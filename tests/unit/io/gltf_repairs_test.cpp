// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/io/gltf_repairs.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;
using namespace io_test;

TEST_CASE("counts keep the largest") {
    GltfRepairs repairs;
    repairs.count_rescaled(0.1);
    repairs.count_rescaled(0.05);
    repairs.count_averaged(0.2);
    CHECK(repairs.rescaled_vertices == 2);
    CHECK(repairs.largest_sum_error == 0.1);
    CHECK(repairs.averaged_places == 1);
    CHECK(repairs.largest_weight_difference == 0.2);
    CHECK(repairs.lost_triangles == 0);
}

TEST_CASE("a file in order needs none; weights that do not sum to one are divided by their sum and counted") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    const auto read = [&] {
        file.write(folder / "a.glb");
        return read_gltf_character(folder / "a.glb");
    };
    CHECK(read().repairs.rescaled_vertices == 0);
    CHECK(read().repairs.averaged_places == 0);
    std::vector<float> weights(64, 0.25F);
    weights[21] = 0.3F;
    file.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = file.add(weights, "VEC4");
    const GltfCharacter character = read();
    CHECK(character.repairs.rescaled_vertices == 1);
    CHECK(character.repairs.largest_sum_error == doctest::Approx(0.05).epsilon(1e-6));
    double sum = 0.0;
    for (const auto& entry : character.weights.row(5)) {
        sum += entry.weight;
    }
    CHECK(sum == doctest::Approx(1.0).epsilon(1e-14));
}
