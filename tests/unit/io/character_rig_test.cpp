// SPDX-License-Identifier: MIT
#include <softtissue/io/character_rig.hpp>

#include "gltf_test_file.hpp"

#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

GltfCharacter read(const TemporaryFolder& folder, const GltfFile& file) {
    file.write(folder / "a.glb");
    return read_gltf_character(folder / "a.glb");
}

Matrix3X<double> skinned(const Matrix3X<double>& rest, const SkinningWeights<double>& weights,
                         const std::vector<AffineTransform<double>>& transforms) {
    MatrixX<double> prepared;
    const LinearBlend<double> policy;
    policy.prepare_into(transforms, prepared);
    Matrix3X<double> x = rest;
    for (Index v = 0; v < x.cols(); ++v) {
        x.col(v) = policy.blend(prepared, weights.row(v))(rest.col(v));
    }
    return x;
}

/// The body's joints, as its regressor gives them.
Matrix3X<double> joints_of(const SmplBody<double>& body) {
    Matrix3X<double> joints = Matrix3X<double>::Zero(3, body.num_joints());
    for (Index j = 0; j < body.num_joints(); ++j) {
        for (SmplBody<double>::SparseMatrix::InnerIterator entry(body.joint_regressor, j); entry; ++entry) {
            joints.col(j) += entry.value() * body.template_vertices.col(entry.col());
        }
    }
    return joints;
}

/// An exporter's usual tree: armature in centimetres, a root joint that only places, the hips that move, a helper.
GltfFile usual_tree() {
    GltfFile file = rigged_bar();
    file.json["nodes"].push_back({{"name", "Armature"},
                                  {"scale", {0.01, 0.01, 0.01}},
                                  {"children", {5}},
                                  {"rotation", {-0.7071067811865476, 0, 0, 0.7071067811865476}}});
    file.json["nodes"].push_back({{"name", "placing"}, {"children", {0, 6}}});
    file.json["nodes"].push_back({{"name", "helper"}});
    file.json["skins"][0]["joints"] = {5, 1, 6, 0, 2};
    std::vector<float> matrices;
    for (const float x : {0.0F, -1.0F, 0.0F, 0.0F, -3.0F}) {
        const std::vector<float> matrix = translation_matrix(x, 0.0F, 0.0F);
        matrices.insert(matrices.end(), matrix.begin(), matrix.end());
    }
    file.json["skins"][0]["inverseBindMatrices"] = file.add(matrices, "MAT4");
    std::vector<std::uint8_t> joints;
    for (int v = 0; v < 16; ++v) {
        for (const int joint : {1, 3, 0, 0}) {
            joints.push_back(std::uint8_t(joint));
        }
    }
    file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = file.add(joints, "VEC4");
    return file;
}

}  // namespace

TEST_CASE("a body of rigid bones moves as the character does") {
    const TemporaryFolder folder;
    for (const GltfFile& file : {rigged_bar(), usual_tree()}) {
        const GltfCharacter character = read(folder, file);
        const CharacterRig rig(character);
        CHECK(rig.num_joints() == 3);  // what only places, and the helper, are no bones
        const SmplBody<double> body = rig.body();
        CHECK(body.joint_names == std::vector<std::string>{"root", "bend", "end"});
        CHECK(body.tree == KinematicTree({-1, 0, 1}));
        validate_closed_surface(body.template_vertices, body.faces, "bar");
        const Matrix3X<double> joints = joints_of(body);
        for (Index j = 0; j < 3; ++j) {
            CHECK((joints.col(j) - character.rest_joint(rig.character_joint(j))).norm() < 1e-12);
        }
        const Motion<double> motion = rig.motion(character.clips[0], 10.0);
        REQUIRE(motion.num_frames() == 11);
        for (const Index frame : {0, 3, 10}) {
            const Pose<double>& pose = motion.poses[size_t(frame)];
            const auto own = character.joint_transforms(character.clips[0], 0.1 * double(frame));
            const Matrix3X<double> x =
                skinned(body.template_vertices, body.weights, joint_transforms(body.tree, joints, pose));
            CHECK((x - skinned(character.positions, character.weights, own)).norm() < 1e-7);
        }
        CHECK(rig.motion(character.clips[0]).frame_rate == 30.0);
    }
}

TEST_CASE("morph targets become shapes, those of the rest are in it") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    file.json["meshes"][0]["weights"] = {0.5};
    const GltfCharacter character = read(folder, file);
    const SmplBody<double> body = CharacterRig(character).body();
    CHECK((body.template_vertices - character.morphed(VectorX<double>::Constant(1, 0.5))).norm() < 1e-15);
    REQUIRE(body.num_shapes() == 1);
    CHECK(body.shape_directions.col(0) == character.morph_targets[0].reshaped());
}

TEST_CASE("several joints without one above: the first takes the others") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    file.json["nodes"][0].erase("children");
    file.json["nodes"][1].erase("translation");
    file.json["animations"][0]["channels"].erase(1);
    const GltfCharacter character = read(folder, file);
    CHECK(CharacterRig(character).tree() == KinematicTree({-1, 0, 1}));
}

TEST_CASE("bones that are scaled or pulled are refused by joint, clip and time") {
    const TemporaryFolder folder;
    GltfFile grown = rigged_bar();
    grown.json["animations"][0]["channels"][0]["target"]["path"] = "scale";
    grown.json["animations"][0]["samplers"][0]["output"] = grown.add(std::vector<float>{1, 1, 1, 1, 1.5, 1}, "VEC3");
    const GltfCharacter grows = read(folder, grown);
    CHECK(contains(refusal([&] { CharacterRig(grows).pose(grows.clips[0], 1.0); }),
                   "a.glb: mesh 'bar': joint 'bend', clip 'wave' at 1.000000 s: the bone is scaled or sheared by 0.5"));
    GltfFile pulled = rigged_bar();
    pulled.json["animations"][0]["channels"][1]["target"]["node"] = 1;
    const GltfCharacter pulls = read(folder, pulled);
    CHECK(contains(
        refusal([&] { CharacterRig(pulls).motion(pulls.clips[0], 30.0); }),
        "joint 'bend', clip 'wave' at 0.000000 s: is 1 m from where its parent puts it, expected at most 0.1"));
    GltfFile drifts = rigged_bar();  // by two hundredths of the longest bone
    drifts.json["animations"][0]["channels"][1]["target"]["node"] = 1;
    drifts.json["animations"][0]["samplers"][1]["output"] =
        drifts.add(std::vector<float>{1, 0, 0, 1, 0.04F, 0}, "VEC3");
    const GltfCharacter drifting = read(folder, drifts);
    const CharacterRig rig(drifting);
    CHECK(rig.motion(drifting.clips[0]).num_frames() == 31);
    const BoneChange change = rig.bone_change(drifting.clips[0]);
    CHECK(change.shift == doctest::Approx(0.04).epsilon(1e-6));
    CHECK(change.shifted_joint == "bend");
    CHECK(change.stretch < 1e-6);
    GltfFile helper = rigged_bar();  // the end has no weights
    helper.json["animations"][0]["channels"][1]["target"]["node"] = 2;
    const GltfCharacter helped = read(folder, helper);
    CHECK(CharacterRig(helped).motion(helped.clips[0], 30.0).num_frames() == 31);
    CHECK(
        contains(refusal([&] { CharacterRig(helped).motion(helped.clips[0], 0.0); }), "frame rate is 0, expected > 0"));
    CHECK(contains(refusal([&] { CharacterRig(helped).motion(helped.clips[0], 1e9); }), "expected less than"));
    GltfClip endless = helped.clips[0];
    endless.end = 1e300;
    CHECK(contains(refusal([&] { CharacterRig(helped).bone_change(endless); }), "expected less than"));
}

TEST_CASE("a flat surface has no place for joints") {
    const TemporaryFolder folder;
    GltfCharacter character = read(folder, rigged_bar());
    character.positions.row(2).setZero();
    character.morph_targets.clear();
    character.morph_weights.resize(0);
    CHECK(contains(refusal([&] { CharacterRig(character).body(); }), "all vertices lie in a plane"));
}
