// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_character.hpp>

#include "io_test_support.hpp"

#include <softtissue/skinning/linear_blend.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

/// Two joints along x below a node that doubles everything, and one vertex of each; made by hand.
GltfCharacter two_joints() {
    GltfCharacter c;
    c.source = "made";
    c.nodes.resize(3);
    c.nodes[1] = {"a", 2, {1, 0, 0}};
    c.nodes[0] = {"b", 1, {1, 0, 0}};
    c.nodes[2].has_matrix = true;
    c.nodes[2].matrix.linear *= 2.0;
    c.node_order = {2, 1, 0};
    c.joint_nodes = {0, 1};
    c.joint_names = {"b", "a"};
    c.inverse_bind.resize(2);
    c.inverse_bind[0] = {Matrix3<double>::Identity() * 0.5, Vector3<double>(-2, 0, 0)};  // bound at x = 4
    c.inverse_bind[1] = {Matrix3<double>::Identity() * 0.5, Vector3<double>(-1, 0, 0)};
    c.positions = (Matrix3X<double>(3, 2) << 5, 3, 0, 0, 0, 0).finished();
    c.weights =
        SkinningWeights<double>(2, std::vector<std::vector<JointWeight<double>>>{{{0, 1.0}}, {{0, 0.5}, {1, 0.5}}});
    c.morph_targets = {Matrix3X<double>::Constant(3, 2, 1.0)};
    c.morph_weights = VectorX<double>::Constant(1, 0.25);
    GltfTrack turn;
    turn.node = 0;
    turn.property = GltfProperty::rotation;
    turn.times = (VectorX<double>(2) << 0, 2).finished();
    turn.values = (MatrixX<double>(4, 2) << 1, std::sqrt(0.5), 0, 0, 0, 0, 0, std::sqrt(0.5)).finished();
    GltfTrack grow = turn;
    grow.node = 1;
    grow.property = GltfProperty::scale;
    grow.values = (MatrixX<double>(3, 2) << 1, 3, 1, 3, 1, 3).finished();
    GltfTrack thicker = turn;
    thicker.node = c.mesh_node;
    thicker.property = GltfProperty::weights;
    thicker.values = (MatrixX<double>(1, 2) << 0, 1).finished();
    c.clips = {{"turn", {turn}, 0, 2}, {"grow", {grow, thicker}, 0, 2}};
    return c;
}

}  // namespace

TEST_CASE("joints stand where their nodes are, and skinning policies take their transforms") {
    const GltfCharacter c = two_joints();
    for (const AffineTransform<double>& T : c.joint_transforms()) {
        CHECK((T.linear - Matrix3<double>::Identity()).norm() < 1e-15);
        CHECK(T.translation.norm() < 1e-15);
    }
    CHECK(c.rest_joint(0) == Vector3<double>(4, 0, 0));
    const auto T = c.joint_transforms(c.clip("turn"), 2.0);  // a quarter turn of b about x = 4
    MatrixX<double> prepared;
    const LinearBlend<double> policy;
    policy.prepare_into(T, prepared);
    const Vector3<double> tip = policy.blend(prepared, c.weights.row(0))(c.positions.col(0));
    CHECK((tip - Vector3<double>(4, 1, 0)).norm() < 1e-14);
    const Vector3<double> between = policy.blend(prepared, c.weights.row(1))(c.positions.col(1));
    CHECK((between - Vector3<double>(3.5, -0.5, 0)).norm() < 1e-14);
    const auto grown = c.joint_transforms(c.clip("grow"), 1.0);
    CHECK((grown[0](Vector3<double>(4, 0, 0)) - Vector3<double>(6, 0, 0)).norm() < 1e-14);
}

TEST_CASE("morph targets add up, at rest and in time") {
    const GltfCharacter c = two_joints();
    CHECK(c.morphed(c.morph_weights) == c.positions + Matrix3X<double>::Constant(3, 2, 0.25));
    CHECK(c.morph_weights_at(c.clip("grow"), 1.0)(0) == 0.5);
    CHECK(c.morph_weights_at(c.clip("turn"), 1.0)(0) == 0.25);
    CHECK(contains(refusal([&] { c.morphed(VectorX<double>::Zero(2)); }),
                   "made: 2 weights of morph targets, expected 1"));
    CHECK(contains(refusal([&] { c.clip("run"); }), "made: no clip 'run'; it has turn, grow"));
}
