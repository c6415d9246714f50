// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/project_targets.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

template <class S>
struct ProjectedCapsule {
    CapsuleBody<S> capsule;
    TriangleMesh mesh{capsule.faces, capsule.positions.cols()};
    RepairedSkin<S> skin = repair_skin(mesh, capsule.positions);

    /// Below each vertex a point of the axis, moved along it.
    Matrix3X<S> axis_points(S along) const {
        Matrix3X<S> points = Matrix3X<S>::Zero(3, capsule.positions.cols());
        points.row(1) = capsule.positions.row(1).cwiseMax(S(0.1)).cwiseMin(S(0.9)).array() + along;
        return points;
    }

    S cosine(const Matrix3X<S>& targets, Index v) const {
        const Matrix3X<S> normals = triangle_normals(capsule.positions, mesh.triangles());
        const Vector3<S> way = targets.col(v) - capsule.positions.col(v);
        return smallest_cosine<S>(incident_columns<S>(mesh, normals, v), way.normalized());
    }
};

}  // namespace

TEST_CASE_TEMPLATE("targets inside the cones stay", S, float, double) {
    const ProjectedCapsule<S> body;
    const Matrix3X<S> targets = body.axis_points(S(0));
    const ProjectedTargets<S> projected = project_targets(body.mesh, body.skin, targets, S(0.3));
    CHECK(projected.points == targets);
    CHECK(projected.redirected == 0);
    CHECK(projected.rounds == 0);
}

TEST_CASE_TEMPLATE("targets outside are turned into them, the others follow a little", S, float, double) {
    const ProjectedCapsule<S> body;
    Matrix3X<S> targets = body.axis_points(S(0));
    const std::int32_t turned = CapsuleBody<S>::vertex(CapsuleBody<S>::num_rings / 2, 3);
    const Vector3<S> outwards(targets(0, turned), targets(1, turned) + S(0.5), targets(2, turned));
    targets.col(turned) = outwards;
    CHECK(body.cosine(targets, turned) < S(0.25));
    const ProjectedTargets<S> projected = project_targets(body.mesh, body.skin, targets, S(0.3));
    CHECK(projected.redirected >= 1);
    CHECK(projected.redirected < 10);
    CHECK(projected.rounds >= 1);
    CHECK(projected.rounds < 12);
    for (Index v = 0; v < targets.cols(); ++v) {
        CHECK(body.cosine(projected.points, v) >= S(0.29));
    }
    const S length = (outwards - body.capsule.positions.col(turned)).norm();
    CHECK((projected.points.col(turned) - body.capsule.positions.col(turned)).norm() ==
          doctest::Approx(double(length)).epsilon(1e-5));
    const std::int32_t neighbour = body.mesh.neighbours(turned).front();
    CHECK(projected.points.col(neighbour) != targets.col(neighbour));
    const std::int32_t far = CapsuleBody<S>::vertex(1, 3);
    CHECK(projected.points.col(far) == targets.col(far));
}

TEST_CASE_TEMPLATE("a target on its skin vertex has no direction and stays there", S, float, double) {
    const ProjectedCapsule<S> body;
    Matrix3X<S> targets = body.axis_points(S(0));
    targets.col(7) = body.capsule.positions.col(7);
    CHECK(project_targets(body.mesh, body.skin, targets, S(0.3)).points == targets);
}
