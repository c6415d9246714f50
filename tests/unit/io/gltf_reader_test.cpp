// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_reader.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

GltfCharacter read(const TemporaryFolder& folder, const GltfFile& file, const GltfReadOptions& options = {}) {
    file.write(folder / "a.glb");
    return read_gltf_character(folder / "a.glb", options);
}

/// The bar with one member of its JSON changed, read.
std::string refused(const TemporaryFolder& folder, const char* pointer, const nlohmann::json& value) {
    GltfFile file = rigged_bar();
    file.json[nlohmann::json::json_pointer(pointer)] = value;
    return refusal([&] { read(folder, file); });
}

}  // namespace

TEST_CASE("the bar comes back from all three kinds of file") {
    const TemporaryFolder folder;
    const GltfFile file = rigged_bar();
    file.write(folder / "a.glb");
    write_bytes(folder / "b.gltf", file.embedded());
    write_bytes(folder / "c.gltf", file.gltf("c.bin"));
    write_bytes(folder / "c.bin", file.bytes);
    for (const char* name : {"a.glb", "b.gltf", "c.gltf"}) {
        CAPTURE(name);
        const GltfCharacter bar = read_gltf_character(folder / name);
        CHECK(bar.source == (folder / name).string() + ": mesh 'bar'");
        CHECK(bar.num_vertices() == 16);
        CHECK(bar.triangles.cols() == 28);
        CHECK(bar.weights.num_joints() == 3);
        CHECK(bar.joint_names == std::vector<std::string>{"root", "bend", "end"});
        CHECK(bar.rest_joint(1) == Vector3<double>(1, 0, 0));
        CHECK(bar.morph_names == std::vector<std::string>{"thick"});
        CHECK(bar.morph_weights == VectorX<double>::Zero(1));
        CHECK(bar.mesh_node == 3);
        REQUIRE(bar.clips.size() == 1);
        const auto T = bar.joint_transforms(bar.clip("wave"), 1.0);
        CHECK((T[2](Vector3<double>(3, 0, 0)) - Vector3<double>(1, 4, 0)).norm() < 1e-6);
        CHECK((T[0](Vector3<double>(3, 0, 0)) - Vector3<double>(3, 2, 0)).norm() < 1e-6);
    }
}

TEST_CASE("what stands above the skeleton brings the rest shape into the scene") {
    const TemporaryFolder folder;
    const GltfCharacter plain = read(folder, rigged_bar());
    // An exporter's armature: centimetres and z up. The bind matrices stay those of the mesh.
    GltfFile file = rigged_bar();
    file.json["nodes"].push_back({{"name", "Armature"},
                                  {"scale", {0.01, 0.01, 0.01}},
                                  {"children", {0}},
                                  {"rotation", {-0.7071067811865476, 0, 0, 0.7071067811865476}}});
    const GltfCharacter small = read(folder, file);
    Matrix3<double> M = Matrix3<double>::Zero();
    M(0, 0) = M(1, 2) = 0.01;
    M(2, 1) = -0.01;
    CHECK((small.positions - M * plain.positions).norm() < 1e-12);
    CHECK((small.morph_targets[0] - M * plain.morph_targets[0]).norm() < 1e-12);
    CHECK((small.rest_joint(2) - M * plain.rest_joint(2)).norm() < 1e-12);
    CHECK(small.triangles == plain.triangles);
    for (const AffineTransform<double>& T : small.joint_transforms()) {
        CHECK((T.linear - Matrix3<double>::Identity()).norm() < 1e-12);
    }
    const auto T = small.joint_transforms(small.clips[0], 0.7);
    const auto expected = plain.joint_transforms(plain.clips[0], 0.7);
    const Vector3<double> tip(3, 0.3, 0.3);
    CHECK((T[1](M * tip) - M * expected[1](tip)).norm() < 1e-12);

    // A mirror above turns the triangles.
    file.json["nodes"][4]["scale"] = {0.01, 0.01, -0.01};
    const GltfCharacter mirrored = read(folder, file);
    CHECK(mirrored.triangles.row(1) == plain.triangles.row(2));
}

TEST_CASE("one mesh of several is chosen by its name or its node's") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    nlohmann::json mesh = file.json["meshes"][0];
    mesh["name"] = "shirt";
    file.json["meshes"].push_back(mesh);
    file.json["nodes"].push_back({{"name", "clothes"}, {"mesh", 1}, {"skin", 0}});
    CHECK(contains(refusal([&] { read(folder, file); }),
                   "a.glb: has 2 skinned meshes (bar, shirt), expected the name of one"));
    CHECK(read(folder, file, {.mesh = "shirt"}).mesh_node == 4);
    CHECK(read(folder, file, {.mesh = "body"}).mesh_node == 3);
    CHECK(contains(refusal([&] { read(folder, file, {.mesh = "hat"}); }), "no skinned mesh 'hat'; it has bar, shirt"));
}

TEST_CASE("vertices are welded unless that is not wanted") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    nlohmann::json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    std::vector<float> positions(48, 0.5F);
    for (std::size_t v = 0; v < 14; ++v) {  // three at one place
        positions[3 * v] = float(v);
    }
    positions[3 * 13] = positions[3 * 14] = positions[3 * 15] = 20.0F;
    attributes["POSITION"] = file.add(positions, "VEC3");
    CHECK(read(folder, file).num_vertices() == 14);
    CHECK(read(folder, file).repairs.lost_triangles > 0);
    CHECK(read(folder, file, {.weld = false}).num_vertices() == 16);
}

TEST_CASE("nodes, skins and meshes that make no character are refused") {
    const TemporaryFolder folder;
    const auto with = [&](const char* pointer, const nlohmann::json& value) { return refused(folder, pointer, value); };
    CHECK(contains(with("/nodes/3", nlohmann::json::object()), "has no skinned mesh"));
    CHECK(contains(with("/nodes/2/children", {0}), "is its own ancestor, expected a tree"));
    CHECK(contains(with("/nodes/1/children", {1}), "nodes[1].children[0] = 1, a node that has a parent already"));
    CHECK(contains(with("/nodes/0/children", {1, 2}), "= 2, a node that has a parent already, expected a tree"));
    CHECK(contains(with("/nodes/0/children", {7}), "nodes[0].children[0] = 7, expected an integer from 0 to 3"));
    CHECK(contains(with("/nodes/0/rotation", {0, 0, 0, 0}), "nodes[0].rotation has length 0, expected 1"));
    CHECK(contains(with("/nodes/0/translation", {0, 0}), "nodes[0].translation = [2 items], expected an array of 3"));
    CHECK(contains(with("/nodes/0/scale", {0, 1, 1}), "joint 'root' is placed by a singular map"));
    CHECK(contains(with("/nodes/3/mesh", 1), "nodes[3].mesh = 1, expected an integer from 0 to 0"));
    CHECK(contains(with("/nodes/3/skin", 1), "nodes[3].skin = 1, expected an integer from 0 to 0"));
    CHECK(contains(with("/skins/0/joints", nlohmann::json::array()), "skins[0]: has no joints"));
    CHECK(contains(with("/skins/0/joints", {0, 9, 1}), "skins[0].joints[1] = 9, expected an integer from 0 to 3"));
    CHECK(contains(with("/skins/0/joints", {0, 1, 0}), "skins[0].joints[2] = 0 appears twice"));
    CHECK(contains(with("/skins/0/joints", {0, 1, 2, 3}), "has 3 matrices, expected 4"));
    CHECK(contains(with("/skins/0/joints", {0}), "expected 0 to 0"));
    CHECK(contains(with("/meshes/0/weights", {1, 2}), "meshes[0].weights = [2 items], expected an array of 1 numbers"));
    nlohmann::json matrix = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    CHECK(contains(with("/nodes/0/matrix", matrix), "nodes[0].matrix: its last row is 1 0 0 1, expected 0 0 0 1"));
    GltfFile flat = rigged_bar();
    std::vector<float> matrices;
    for (int j = 0; j < 3; ++j) {
        const std::vector<float> one = translation_matrix(0, 0, 0);
        matrices.insert(matrices.end(), one.begin(), one.end());
    }
    matrices[16] = 0.0F;
    flat.json["skins"][0]["inverseBindMatrices"] = flat.add(matrices, "MAT4");
    CHECK(contains(refusal([&] { read(folder, flat); }), "inverseBindMatrices, matrix 1 is singular"));
}

TEST_CASE("no cut or changed byte makes more than a refusal") {
    const TemporaryFolder folder;
    const std::string whole = rigged_bar().glb();
    const auto survives = [&](const std::string& bytes) {
        write_bytes(folder / "a.glb", bytes);
        try {
            return read_gltf_character(folder / "a.glb").num_vertices() > 0;
        } catch (const InvalidInput& error) {
            return contains(error.what(), "a.glb");
        }
    };
    for (std::size_t size = 0; size < whole.size(); size += 37) {
        CHECK(survives(whole.substr(0, size)));
    }
    for (std::size_t place = 0; place < whole.size(); place += 11) {
        std::string bytes = whole;
        bytes[place] = char(bytes[place] ^ (1 << place % 8));
        CAPTURE(place);
        CHECK(survives(bytes));
    }
}
