// SPDX-License-Identifier: MIT
#include <softtissue/model/human_skinning.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;

namespace {

struct Skinned {
    HumanMesh mesh = make_human_mesh();
    MatrixX<double> weights = HumanSkinning(human_rest_joints()).weights(mesh);
};

const Skinned& skinned() {
    static const Skinned result;
    return result;
}

double weight_near(const Vector3<double>& x, Index joint) {
    Index v = 0;
    (skinned().mesh.vertices.colwise() - x).colwise().squaredNorm().minCoeff(&v);
    return skinned().weights(joint, v);
}

}  // namespace

TEST_CASE("human skinning: not negative, sums of one, at most six joints, no specks") {
    const MatrixX<double>& w = skinned().weights;
    CHECK(w.minCoeff() >= 0.0);
    for (Index v = 0; v < w.cols(); ++v) {
        CHECK(std::abs(w.col(v).sum() - 1.0) < 1e-14);
        CHECK(size_t((w.col(v).array() > 0.0).count()) <= HumanSkinning::max_joints);
        CHECK((w.col(v).array() == 0.0 || w.col(v).array() > 1e-3).all());
    }
}

TEST_CASE("human skinning: mirrored vertices have mirrored weights to the bit") {
    const Skinned& s = skinned();
    for (Index v = 0; v < s.weights.cols(); ++v) {
        for (Index j = 0; j < s.weights.rows(); ++j) {
            CHECK(s.weights(j, v) == s.weights(mirror_joint(j), s.mesh.mirror[size_t(v)]));
        }
    }
}

TEST_CASE("human skinning: every joint holds the middle of its own part") {
    using namespace human_joint;
    const Matrix3X<double> J = human_rest_joints();
    const auto between = [&J](Index a, Index b) -> Vector3<double> { return 0.5 * (J.col(a) + J.col(b)); };
    for (const Index side : {Index(0), Index(1)}) {
        CHECK(weight_near(between(hip + side, knee + side), hip + side) > 0.95);
        CHECK(weight_near(between(knee + side, ankle + side), knee + side) > 0.95);
        CHECK(weight_near(between(shoulder + side, elbow + side), shoulder + side) > 0.95);
        CHECK(weight_near(between(elbow + side, wrist + side), elbow + side) > 0.95);
        CHECK(weight_near(J.col(ankle + side) + Vector3<double>(0.0, -0.04, -0.07), ankle + side) > 0.85);
        CHECK(weight_near(J.col(foot + side) + Vector3<double>(0.0, 0.0, 0.07), foot + side) > 0.9);
        CHECK(weight_near(2.0 * J.col(hand + side) - J.col(wrist + side), hand + side) > 0.9);
    }
    CHECK(weight_near({0.0, 1.73, 0.0}, head) > 0.99);
    CHECK(weight_near({0.0, 1.52, 0.09}, head) > 0.7);  // the chin
    CHECK(weight_near({0.0, 0.94, 0.1}, pelvis) > 0.8);
    CHECK(weight_near({0.0, 1.35, -0.14}, spine3) > 0.8);
}

TEST_CASE("human skinning: no weight leaps from limb to limb through the air") {
    using namespace human_joint;
    const Skinned& s = skinned();
    for (Index v = 0; v < s.weights.cols(); ++v) {
        const Vector3<double> x = s.mesh.vertices.col(v);
        if (x(1) < 0.62 && x(0) > 0.0) {  // left leg, beyond the smoothing from the crotch
            CHECK(s.weights(hip, v) + s.weights(knee, v) + s.weights(ankle, v) + s.weights(foot, v) ==
                  doctest::Approx(1.0));
        }
        if (x(0) > 0.3) {  // left arm
            CHECK(s.weights(shoulder, v) + s.weights(elbow, v) + s.weights(wrist, v) + s.weights(hand, v) > 0.99);
        }
        if (x(1) > 0.85 && x(1) < 1.1 && std::abs(x(0)) < 0.25) {  // hips and waist
            CHECK(s.weights(shoulder, v) + s.weights(shoulder + 1, v) == 0.0);
        }
    }
}
