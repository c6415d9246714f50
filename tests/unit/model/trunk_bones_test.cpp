// SPDX-License-Identifier: MIT
#include <softtissue/model/trunk_bones.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace softtissue;

TEST_CASE("the bones of the trunk lie in the bone wrap; those of the mid-line are symmetric") {
    const TubeBody& body = tube_body();
    const RayDistance<double> bone(body.bone, body.triangles);
    const RayDistance<double> muscle(body.muscle, body.triangles);
    const WindingNumber<double> wrap(body.bone, body.triangles);
    const BodySide left(body.joints, bone, muscle, false);
    TrunkBones bones(left, 1.0, 0.75);
    std::set<std::string> names;
    for (const AnatomyMesh<double>& mesh : bones.paired()) {
        CAPTURE(mesh.name);
        check_surface(mesh);
        CHECK(enclosed_part(mesh.positions, wrap) == 1.0);
        CHECK(mesh.positions.row(0).minCoeff() > -0.01);  // left of the mid-line
        names.insert(mesh.name);
    }
    CHECK(names.size() == 3 + 12);
    names.clear();
    for (const AnatomyMesh<double>& mesh : bones.middle()) {
        CAPTURE(mesh.name);
        check_surface(mesh);
        CHECK(enclosed_part(mesh.positions, wrap) == 1.0);
        CHECK(mesh.positions.row(0).maxCoeff() == doctest::Approx(-mesh.positions.row(0).minCoeff()).epsilon(1e-6));
        names.insert(mesh.name);
    }
    CHECK(names.size() == 2 + 21);
}
