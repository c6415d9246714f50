// SPDX-License-Identifier: MIT
#include <softtissue/model/bone_lofts.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

struct Probe : BoneLofts {
    using BoneLofts::BoneLofts;
    using BoneLofts::chest;
    using BoneLofts::chest_radius;
    using BoneLofts::start;
    using BoneLofts::tube;
};

}  // namespace

TEST_CASE("a tube as drawn, and one too wide drawn back into the bone wrap") {
    const TubeBody& body = tube_body();
    const RayDistance<double> bone(body.bone, body.triangles);
    const RayDistance<double> muscle(body.muscle, body.triangles);
    const BodySide left(body.joints, bone, muscle, false);
    const Vector3<double> a = left.joint(human_joint::spine1);
    const WindingNumber<double> wrap(body.bone, body.triangles);
    const auto tube_of = [&](double width, double scale, double density) {
        Probe lofts(left, scale, density);
        lofts.start("tube");
        lofts.tube([&](double u) { return Vector3<double>(a + 0.05 * u * Vector3<double>::UnitY()); },
                   [&](double) { return Eigen::Vector2d(width, 0.5 * width); }, Vector3<double>::UnitX(),
                   Vector3<double>::UnitZ(), a, 10, 12, 0.1);
        return lofts.take().front();
    };
    const AnatomyMesh<double> slim = tube_of(10, 1.0, 1.0);
    check_surface(slim);
    CHECK(slim.name == "tube");
    CHECK(slim.kind == AnatomyKind::bone);
    CHECK(slim.positions.row(0).maxCoeff() == doctest::Approx(0.010));
    CHECK(tube_of(10, 1.5, 1.0).positions.row(0).maxCoeff() == doctest::Approx(0.015));
    CHECK(tube_of(10, 1.0, 2.0).positions.cols() == 20 * 24 + 2);
    const AnatomyMesh<double> wide = tube_of(500, 1.0, 1.0);
    check_surface(wide);
    CHECK(enclosed_part(wide.positions, wrap) == 1.0);
}

TEST_CASE("the chest is an ellipse with the trunk's table as half axes") {
    const TubeBody& body = tube_body();
    const RayDistance<double> bone(body.bone, body.triangles);
    const RayDistance<double> muscle(body.muscle, body.triangles);
    const BodySide left(body.joints, bone, muscle, false);
    const Probe lofts(left, 1.0, 1.0);
    const TrunkShape shape = smpl_anatomy().trunk;
    CHECK(lofts.chest_radius(0.6, 90) == doctest::Approx(0.8 * shape.half_width(0.6)));
    CHECK(lofts.chest_radius(0.6, 180) == doctest::Approx(0.8 * shape.half_depth(0.6)));
    CHECK(WindingNumber<double>(body.bone, body.triangles)(lofts.chest(0.6, 70, 5.0)) > 0.5);
}
