// SPDX-License-Identifier: MIT
#include <softtissue/model/limb_bones.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace softtissue;

TEST_CASE("the long bones lie in the bone wrap, between their joints") {
    const TubeBody& body = tube_body();
    const RayDistance<double> bone(body.bone, body.triangles);
    const RayDistance<double> muscle(body.muscle, body.triangles);
    const WindingNumber<double> wrap(body.bone, body.triangles);
    const BodySide left(body.joints, bone, muscle, false);
    std::set<std::string> names;
    for (const AnatomyMesh<double>& mesh : LimbBones(left, 1.0, 0.75)()) {
        CAPTURE(mesh.name);
        check_surface(mesh);
        CHECK(mesh.kind == AnatomyKind::bone);
        CHECK(enclosed_part(mesh.positions, wrap) == 1.0);
        names.insert(mesh.name);
        if (mesh.name == "femur") {
            const Vector3<double> extent = mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff();
            const double length = (left.joint(human_joint::hip) - left.joint(human_joint::knee)).norm();
            CHECK(extent(1) == doctest::Approx(length).epsilon(0.1));
        }
    }
    CHECK(names == std::set<std::string>{"femur", "patella", "tibia", "fibula", "humerus", "radius", "ulna"});
}
