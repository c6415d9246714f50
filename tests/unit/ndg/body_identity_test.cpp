// SPDX-License-Identifier: MIT
#include <softtissue/ndg/body_identity.hpp>

#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

#include <string>
#include <utility>

using namespace softtissue;
using namespace softtissue_test;

namespace {

const KinematicTree two_joints({KinematicTree::no_parent, 0});

std::string difference(const BodyIdentity& made_for, const BodyIdentity& body) {
    try {
        made_for.require_same(body, "a.safetensors");
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a body of another shape or precision is the same body") {
    LayeredLimb<double> limb;
    const BodyIdentity identity = body_identity(limb.body, two_joints, {"hip", "knee"});
    CHECK(identity.num_vertices == 300);
    CHECK(identity.num_cells == 360);
    CHECK(body_identity(LayeredLimb<float>().body, two_joints, {"hip", "knee"}) == identity);
    limb.body.mesh.rest_positions *= 2;
    CHECK(body_identity(limb.body, two_joints, {"hip", "knee"}) == identity);
    CHECK(difference(identity, body_identity(limb.body, two_joints)).empty());  // no names to compare
}

TEST_CASE("another body is named by what is different") {
    const LayeredLimb<double> limb;
    const BodyIdentity identity = body_identity(limb.body, two_joints, {"hip", "knee"});
    const auto with = [&](auto&& change) {
        LayeredLimb<double> other;
        change(other.body);
        return difference(identity, body_identity(other.body, two_joints, {"hip", "knee"}));
    };
    const std::string other_cells =
        "a.safetensors: made for a body of the same size whose cells or prescribed vertices are others";
    CHECK(with([](LayeredBody<double>& body) { std::swap(body.mesh.cells(0, 7), body.mesh.cells(1, 7)); }) ==
          other_cells);
    CHECK(with([](LayeredBody<double>& body) { body.prescribed.pop_back(); }) == other_cells);
    CHECK(with([](LayeredBody<double>& body) { body.mesh.cells.conservativeResize(6, 359); }) ==
          "a.safetensors: made for a body of 300 vertices and 360 cells, this one has 300 and 359");
    CHECK(difference(identity, body_identity(limb.body, two_joints, {"knee", "hip"})) ==
          "a.safetensors: made for a body whose joint 0 is 'hip', here it is 'knee'");
    CHECK(
        difference(identity, body_identity(limb.body, KinematicTree({1, KinematicTree::no_parent}), {"hip", "knee"})) ==
        "a.safetensors: made for a body whose joint 0 hangs from joint -1, here from 1");
    CHECK(difference(identity, body_identity(limb.body, KinematicTree({KinematicTree::no_parent, 0, 1}))) ==
          "a.safetensors: made for a body of 2 joints, this one has 3");
    CHECK_THROWS_WITH_AS(body_identity(limb.body, two_joints, {"hip"}), "body identity: 1 joint names, expected 2",
                         InvalidInput);
}
