// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/skeleton_projection.hpp>

#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("closest points on a forked skeleton", S, float, double) {
    // A T: root at the origin, a bone up to (0, 1, 0), from there to (-1, 1, 0) and (1, 1, 0); leaves are ends of bones.
    Matrix3X<S> joints(3, 4);
    joints << 0, 0, -1, 1, 0, 1, 1, 1, 0, 0, 0, 0;
    const BoneSegments<S> bones(KinematicTree({-1, 0, 1, 1}), joints);
    const auto closest = [&](S x, S y, S z) { return bones.closest_point(Vector3<S>(x, y, z)); };
    CHECK(closest(S(0.25), S(0.5), S(1)) == Vector3<S>(0, S(0.5), 0));
    CHECK(closest(S(0.5), S(2), S(1)) == Vector3<S>(S(0.5), 1, 0));
    CHECK(closest(S(3), S(2), S(1)) == Vector3<S>(1, 1, 0));   // beyond a leaf
    CHECK(closest(S(0), S(-2), S(1)) == Vector3<S>(0, 0, 0));  // before the root
}

TEST_CASE("no sampled point of the bones is closer") {
    RandomGenerator random(3);
    Matrix3X<double> joints(3, 5);
    for (double& x : joints.reshaped()) {
        x = random.uniform(-1, 1);
    }
    const KinematicTree tree({-1, 0, 0, 2, 3});
    const BoneSegments<double> bones(tree, joints);
    for (int sample = 0; sample < 50; ++sample) {
        const Vector3<double> point(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
        double smallest = std::numeric_limits<double>::infinity();
        for (Index j = 1; j < 5; ++j) {
            for (int k = 0; k <= 1000; ++k) {
                const double t = k / 1000.0;
                smallest =
                    std::min(smallest, (joints.col(tree.parent(j)) * (1 - t) + joints.col(j) * t - point).norm());
            }
        }
        const double distance = (bones.closest_point(point) - point).norm();
        CHECK(distance <= smallest + 1e-12);
        CHECK(distance >= smallest - 4e-3);  // half a sample apart on the longest bone
    }
}

TEST_CASE("a single joint is a point; joints that do not fit are refused") {
    const KinematicTree point({-1});
    CHECK(BoneSegments<double>(point, Vector3<double>(1, 2, 3)).closest_point(Vector3<double>::Zero()) ==
          Vector3<double>(1, 2, 3));
    CHECK_THROWS_WITH_AS(BoneSegments<double>(point, Matrix3X<double>::Zero(3, 2)),
                         "skeleton: 2 joint positions, expected 1", InvalidInput);
    CHECK_THROWS_WITH_AS(
        BoneSegments<double>(point, Matrix3X<double>::Constant(3, 1, std::numeric_limits<double>::quiet_NaN())),
        "skeleton: position of joint 0 is not finite", InvalidInput);
}

TEST_CASE("smoothing spreads projections along the bones and keeps them there") {
    const CapsuleBody<double> body;
    const TriangleMesh mesh(body.faces, body.positions.cols());
    // A sideways bone end attracts one side of the capsule; smoothing pulls neighbours' projections together.
    Matrix3X<double> joints = body.joints;
    joints.col(2) << 0.5, 0.5, 0;
    const BoneSegments<double> bones(body.tree, joints);
    const auto roughness = [&](const Matrix3X<double>& p) {
        double sum = 0;
        for (const TriangleMesh::Edge& edge : mesh.edges()) {
            sum += (p.col(edge.vertices[0]) - p.col(edge.vertices[1])).squaredNorm();
        }
        return sum;
    };
    const Matrix3X<double> rough = project_to_skeleton(mesh, body.positions, bones, 0);
    const Matrix3X<double> smooth = project_to_skeleton(mesh, body.positions, bones, 20);
    CHECK(roughness(smooth) < 0.5 * roughness(rough));
    for (Index v = 0; v < smooth.cols(); ++v) {
        CHECK((bones.closest_point(smooth.col(v)) - smooth.col(v)).norm() < 1e-12);
    }
}

TEST_CASE("the boundary keeps its projections: on a straight bone nothing moves") {
    const CapsuleBody<double> body;
    Triangles open(3, 0);
    for (Index f = 0; f < body.faces.cols(); ++f) {
        if (body.faces.col(f).maxCoeff() < body.vertex(body.num_rings, 0)) {
            open.conservativeResize(3, open.cols() + 1);
            open.col(open.cols() - 1) = body.faces.col(f);
        }
    }
    const Matrix3X<double> sides = body.positions.leftCols(body.vertex(body.num_rings, 0));
    const TriangleMesh mesh(open, sides.cols());
    const BoneSegments<double> bones(body.tree, body.joints);
    const Matrix3X<double> nearest = project_to_skeleton(mesh, sides, bones, 0);
    CHECK((project_to_skeleton(mesh, sides, bones, 50) - nearest).cwiseAbs().maxCoeff() < 1e-12);
}
