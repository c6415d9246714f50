// SPDX-License-Identifier: MIT
#include <softtissue/model/procedural_muscles.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

TEST_CASE("muscles fill the space between bone wrap and muscle wrap") {
    const TubeBody& body = tube_body();
    const RayDistance<double> bone(body.bone, body.triangles);
    const RayDistance<double> muscle(body.muscle, body.triangles);
    const WindingNumber<double> bone_wrap(body.bone, body.triangles);
    const WindingNumber<double> muscle_wrap(body.muscle, body.triangles);
    const BodySide left(body.joints, bone, muscle, false);
    const std::vector<AnatomyMesh<double>> muscles = procedural_muscles(left, 1.0, 0.75);
    CHECK(muscles.size() == muscle_designs().size());
    double in_muscle_wrap = 0;
    double in_bone_wrap = 0;
    Index vertices = 0;
    for (const AnatomyMesh<double>& mesh : muscles) {
        CAPTURE(mesh.name);
        check_surface(mesh);
        CHECK(mesh.kind == AnatomyKind::muscle);
        in_muscle_wrap += double(mesh.positions.cols()) * enclosed_part(mesh.positions, muscle_wrap);
        in_bone_wrap += double(mesh.positions.cols()) * enclosed_part(mesh.positions, bone_wrap);
        vertices += mesh.positions.cols();
    }
    // Rays that cross a wrap more than once (shoulder, groin) take the first wall.
    CHECK(in_muscle_wrap > 0.98 * double(vertices));
    CHECK(in_bone_wrap < 0.05 * double(vertices));
    CHECK(procedural_muscles(left, 1.0, 1.5).front().positions.cols() > 3 * muscles.front().positions.cols());
}
