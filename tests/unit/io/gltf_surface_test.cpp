// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_surface.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

GltfSurface read(const TemporaryFolder& folder, const GltfFile& file, Index num_joints = 3) {
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    return read_gltf_surface(document, document.element("meshes", 0), num_joints);
}

nlohmann::json& part_of(GltfFile& file) {
    return file.json["meshes"][0]["primitives"][0];
}

}  // namespace

TEST_CASE("vertices, triangles, weights and morph targets of the bar") {
    const TemporaryFolder folder;
    const GltfSurface bar = read(folder, rigged_bar());
    CHECK(bar.positions.cols() == 16);
    CHECK(bar.positions(0, 15) == 3.0);
    CHECK(bar.triangles.cols() == 28);
    CHECK(bar.triangles.col(0) == Eigen::Vector3i(0, 2, 1));
    REQUIRE(bar.weights[0].size() == 1);
    CHECK(bar.weights[0][0].joint == 0);
    REQUIRE(bar.weights[4].size() == 2);  // sorted, whatever the order in the file
    CHECK(bar.weights[4][0].joint == 0);
    CHECK(bar.weights[4][0].weight == 0.5);
    REQUIRE(bar.morph_targets.size() == 1);
    CHECK(bar.morph_targets[0](1, 1) == double(0.1F));
    CHECK(bar.welded_vertex[7] == 7);
}

TEST_CASE("strips, fans and parts without indices; several parts follow each other") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    nlohmann::json part = part_of(file);
    part.erase("indices");
    part["mode"] = 5;
    file.json["meshes"][0]["primitives"].push_back(part);
    part["mode"] = 6;
    part["targets"] = nlohmann::json::array({nlohmann::json::object()});  // a target that moves other attributes only
    file.json["meshes"][0]["primitives"].push_back(part);
    const GltfSurface surface = read(folder, file);
    CHECK(surface.positions.cols() == 48);
    CHECK(surface.triangles.cols() == 28 + 14 + 14);
    CHECK(surface.triangles.col(28) == Eigen::Vector3i(16, 17, 18));
    CHECK(surface.triangles.col(29) == Eigen::Vector3i(17, 19, 18));  // every second one of a strip is turned
    CHECK(surface.triangles.col(43) == Eigen::Vector3i(34, 35, 32));
    CHECK(surface.morph_targets[0].rightCols(16).norm() == 0.0);
    part["mode"] = 1;
    file.json["meshes"][0]["primitives"].push_back(part);
    CHECK(contains(refusal([&] { read(folder, file); }), "meshes[0].primitives[3].mode = 1, expected triangles"));
}

TEST_CASE("weights in bytes, words and in several sets") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> words, joints;
    for (int v = 0; v < 16; ++v) {
        for (const int weight : {100, 55, 0, 0}) {
            bytes.push_back(std::uint8_t(weight));
        }
        for (const int weight : {25700, 0, 0, 0}) {
            words.push_back(std::uint16_t(weight));
        }
        for (const int joint : {1, 7, 7, 7}) {  // what has no weight may be anything
            joints.push_back(std::uint16_t(joint));
        }
    }
    nlohmann::json& attributes = part_of(file)["attributes"];
    attributes["WEIGHTS_0"] = file.add(bytes, "VEC4", true);
    attributes["WEIGHTS_1"] = file.add(words, "VEC4", true);
    attributes["JOINTS_1"] = file.add(joints, "VEC4");
    const GltfSurface surface = read(folder, file);
    REQUIRE(surface.weights[3].size() == 2);
    CHECK(surface.weights[3][0].joint == 0);
    CHECK(surface.weights[3][0].weight == doctest::Approx(55.0 / 255).epsilon(1e-5));
    CHECK(surface.weights[3][1].weight == doctest::Approx(200.0 / 255).epsilon(1e-5));
}

TEST_CASE("arrays that do not fit are refused") {
    const TemporaryFolder folder;
    const auto refused = [&](const auto& change, Index num_joints = 3) {
        GltfFile file = rigged_bar();
        change(file);
        return refusal([&] { read(folder, file, num_joints); });
    };
    const auto with_attribute = [&](const char* name, const auto& values, const char* type, bool normalized = false) {
        return refused([&](GltfFile& file) { part_of(file)["attributes"][name] = file.add(values, type, normalized); });
    };
    std::vector<float> weights(64, 0.0F);
    CHECK(contains(with_attribute("WEIGHTS_0", weights, "VEC4"),
                   "a.glb: meshes[0].primitives[0]: weights of vertex 0 are all zero, expected a sum of 1"));
    weights.assign(64, 0.25F);
    weights[21] = -0.25F;
    CHECK(contains(with_attribute("WEIGHTS_0", weights, "VEC4"),
                   "WEIGHTS_0: weight 1 of vertex 5 = -0.25, expected >= 0"));
    CHECK(contains(with_attribute("WEIGHTS_0", std::vector<std::uint8_t>(64, 1), "VEC4"), "expected 5126, or 5121"));
    CHECK(contains(with_attribute("WEIGHTS_0", std::vector<float>(60, 0.25F), "VEC4"),
                   "WEIGHTS_0: has 15 elements, expected 16 as POSITION"));
    CHECK(contains(with_attribute("JOINTS_0", std::vector<float>(64, 1.0F), "VEC4"), "JOINTS_0: componentType = 5126"));
    CHECK(contains(with_attribute("JOINTS_0", std::vector<std::uint8_t>(64, 9), "VEC4"),
                   "joint 1 of vertex 0 = 9, expected 0 to 2"));
    CHECK(contains(refused([](GltfFile&) {}, 1), "expected 0 to 0"));
    CHECK(contains(refused([](GltfFile& file) {
                       part_of(file)["indices"] = file.add(std::vector<std::uint16_t>{0, 1, 16}, "SCALAR");
                   }),
                   "primitives[0].indices: index 2 = 16, expected 0 to 15"));
    CHECK(contains(refused([](GltfFile& file) {
                       part_of(file)["indices"] = file.add(std::vector<std::uint16_t>{0, 1}, "SCALAR");
                   }),
                   "has 2 corners of triangles, expected a multiple of 3"));
    CHECK(contains(refused([](GltfFile& file) {
                       part_of(file)["indices"] = file.add(std::vector<float>{0, 1, 2}, "SCALAR");
                   }),
                   "indices: componentType = 5126, expected an unsigned integer"));
    CHECK(contains(refused([](GltfFile& file) {
                       part_of(file)["targets"][0]["POSITION"] = file.add(std::vector<float>(45, 0.0F), "VEC3");
                   }),
                   "targets[0].POSITION: has 15 elements, expected 16"));
    CHECK(contains(refused([](GltfFile& file) { part_of(file)["attributes"].erase("JOINTS_0"); }),
                   "JOINTS_0 is missing"));
    CHECK(contains(refused([](GltfFile& file) { file.json["meshes"][0].erase("primitives"); }), "has no primitives"));
    CHECK(contains(refused([](GltfFile& file) {
                       nlohmann::json part = part_of(file);
                       part.erase("targets");
                       file.json["meshes"][0]["primitives"].push_back(part);
                   }),
                   "primitives[1]: has 0 morph targets, expected 1"));
}

TEST_CASE("many targets that say nothing are counted like those with numbers") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    for (int k = 0; k < 100000; ++k) {
        part_of(file)["targets"].push_back(nlohmann::json::object());
    }
    CHECK(contains(refusal([&] { read(folder, file); }), "numbers would make more than 64 bytes for every byte"));
}
