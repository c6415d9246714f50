// SPDX-License-Identifier: MIT
#include <softtissue/model/body_side.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace softtissue;

namespace {

struct Sides {
    const TubeBody& body = tube_body();
    RayDistance<double> bone{body.bone, body.triangles};
    RayDistance<double> muscle{body.muscle, body.triangles};
    BodySide left{body.joints, bone, muscle, false};
    BodySide right{body.joints, bone, muscle, true};
};

}  // namespace

TEST_CASE("the right side is seen as a left one") {
    const Sides sides;
    CHECK(sides.right.joint(human_joint::knee) == sides.left.joint(human_joint::knee));
    const Vector3<double> o = sides.left.joint(human_joint::hip);
    const Vector3<double> d = Vector3<double>(1, -0.2, 0.4).normalized();
    const double expected = sides.bone(mirrored(o), mirrored(d));
    CHECK(sides.right.bone_distance(o, d) == expected);
    CHECK(sides.left.bone_distance(o, d) == doctest::Approx(expected).epsilon(1e-9));
    CHECK(sides.left.bone_distance(o, d) < sides.left.muscle_distance(o, d));
}

TEST_CASE("points are drawn back into the bone wrap") {
    const Sides sides;
    const Vector3<double> o = sides.left.joint(human_joint::spine1);
    const Vector3<double> d = Vector3<double>::UnitX();
    const double wall = sides.left.bone_distance(o, d);
    REQUIRE(wall > 0.02);
    const Vector3<double> near = o + 0.5 * wall * d;
    CHECK(sides.left.within_bone(o, near, 0.003) == near);
    CHECK((sides.left.within_bone(o, o + 3 * wall * d, 0.003) - o).norm() == doctest::Approx(wall - 0.003));
    CHECK((sides.left.within_bone(o, o + 3 * wall * d, 10.0) - o).norm() == doctest::Approx(0.5 * wall));
    CHECK(sides.left.within_bone(o, o, 0.003) == o);
}

TEST_CASE("charts: axes, directions, shares of the way between the wraps") {
    const Sides sides;
    const BodyChart thigh = BodyChart::limb(sides.left, human_joint::hip, human_joint::knee, 0.2);
    CHECK((thigh.origin(0.0) - sides.left.joint(human_joint::hip)).norm() < 1e-12);
    CHECK((thigh.origin(1.0) - sides.left.joint(human_joint::knee)).norm() < 1e-12);
    CHECK(thigh.direction(0)(2) > 0.99);   // front
    CHECK(thigh.direction(90)(0) > 0.99);  // outwards
    CHECK(thigh.direction(180)(2) < -0.99);
    const BodyChart arm = BodyChart::limb(sides.left, human_joint::shoulder, human_joint::elbow, 0.2);
    CHECK(arm.direction(90)(1) > 0.5);  // the upper side of the arm
    const BodyChart trunk = BodyChart::trunk(sides.left, 0.3);
    CHECK((trunk.direction(90) - Vector3<double>::UnitX()).norm() < 1e-15);
    CHECK(trunk.origin(0.0)(1) == doctest::Approx(sides.left.joint(human_joint::pelvis)(1)));
    for (double t = 0.05; t < 0.8; t += 0.15) {
        // In the middle between front and back, up to the linear interpolation of the chain.
        const double front = sides.left.bone_distance(trunk.origin(t), trunk.direction(0));
        const double back = sides.left.bone_distance(trunk.origin(t), trunk.direction(180));
        CHECK(std::abs(front - back) < 0.006);
    }
    for (const BodyChart* chart : {&thigh, &arm, &trunk}) {
        for (double angle = 0; angle < 360; angle += 45) {
            const auto [bone, muscle] = chart->wraps(0.5, angle);
            CHECK(bone < muscle);
            const Vector3<double> o = chart->origin(0.5);
            CHECK((chart->point(0.5, angle, 0.0) - o).norm() == doctest::Approx(bone));
            CHECK((chart->point(0.5, angle, 1.0) - o).norm() == doctest::Approx(muscle));
        }
    }
}

TEST_CASE("a limb whose wraps are cut ends at the cut") {
    const TubeBody& body = tube_body();
    const double cut = 0.25;  // half way down the shank, which ends at 0.08
    std::vector<Index> kept;
    for (Index t = 0; t < body.triangles.cols(); ++t) {
        if (body.bone(1, body.triangles(0, t)) > cut) {
            kept.push_back(t);
        }
    }
    Triangles above(3, Index(kept.size()));
    for (size_t i = 0; i < kept.size(); ++i) {
        above.col(Index(i)) = body.triangles.col(kept[i]);
    }
    const RayDistance<double> bone(body.bone, above);
    const RayDistance<double> muscle(body.muscle, above);
    const BodySide left(body.joints, bone, muscle, false);
    const BodyChart shank = BodyChart::limb(left, human_joint::knee, human_joint::ankle, 0.1);
    CHECK(shank.origin(1.0)(1) > cut - 0.02);
    CHECK(shank.origin(1.0)(1) < cut + 0.04);
    CHECK((shank.origin(0.3) - (0.7 * left.joint(human_joint::knee) + 0.3 * left.joint(human_joint::ankle))).norm() <
          1e-12);
}
