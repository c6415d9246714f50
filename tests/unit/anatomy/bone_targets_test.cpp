// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/bone_targets.hpp>

#include <softtissue/model/human_solid.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace softtissue;

namespace {

/// A skeleton, and a tube of trunk skin around it: 0.16 m wide, 0.12 m deep, its middle 0.03 m before the spine.
template <class S>
struct TrunkSkin {
    static constexpr Index num_rings = 65;
    static constexpr Index num_sectors = 24;

    BodyAnatomy anatomy = smpl_anatomy();
    Matrix3X<S> joints = human_rest_joints().cast<S>();
    Matrix3X<S> skin{3, num_rings* num_sectors};
    MatrixX<S> weights = MatrixX<S>::Zero(24, num_rings* num_sectors);
    Vector3<S> up;
    Vector3<S> left;
    Vector3<S> front;
    S length;

    TrunkSkin() {
        joints.row(0).array() -= joints(0, 0);
        up = joints.col(12) - joints.col(0);
        length = up.norm();
        up /= length;
        left = Vector3<S>::UnitX();
        front = left.cross(up);
        for (Index ring = 0; ring < num_rings; ++ring) {
            for (Index k = 0; k < num_sectors; ++k) {
                const double angle = 2 * std::numbers::pi * double(k) / double(num_sectors);
                skin.col(ring * num_sectors + k) =
                    at(S(-0.5) + S(ring) / S(32), S(0.16 * std::cos(angle)), S(0.12 * std::sin(angle)));
            }
        }
        weights.row(3).setOnes();
    }

    Vector3<S> centre(S t) const { return joints.col(0) + t * length * up + S(0.03) * front; }
    Vector3<S> at(S t, S x, S z) const { return centre(t) + x * left + z * front; }
    BoneTargets<S> bones() const { return BoneTargets<S>(anatomy, joints, skin, weights); }
};

template <class S>
constexpr double rounding = double(64 * std::numeric_limits<S>::epsilon());

}  // namespace

TEST_CASE_TEMPLATE("limb: the tube's radius, or a part of the way where the limb is thin", S, float, double) {
    TrunkSkin<S> trunk;
    trunk.weights.col(0).setZero();
    trunk.weights(1, 0) = S(1);  // left thigh
    const BoneTargets<S> bones = trunk.bones();
    const Vector3<S> hip = trunk.joints.col(1);
    const Vector3<S> axis = trunk.joints.col(4) - hip;
    const Vector3<S> out = axis.cross(Vector3<S>::UnitZ()).normalized();
    const Vector3<S> middle = hip + S(0.45) * axis;
    const S radius = bones.scale() * S(trunk.anatomy.limbs[0].radius(0.45));
    CHECK((bones.target(0, middle + S(0.08) * out) - (middle + radius * out)).norm() < rounding<S>);
    CHECK((bones.target(0, middle + S(0.02) * out) - (middle + S(0.72 * 0.02) * out)).norm() < rounding<S>);
    // Beyond the knee: around the knee itself.
    const Vector3<S> beyond = hip + axis + S(0.1) * axis.normalized();
    const S end = bones.scale() * S(trunk.anatomy.limbs[0].radius(1));
    CHECK((bones.target(0, beyond) - (hip + axis + end * axis.normalized())).norm() < rounding<S>);
    CHECK((bones.target(0, middle) - middle).norm() < rounding<S>);  // on the bone
}

TEST_CASE_TEMPLATE("trunk: an ellipse in the middle of the skin, a floor below", S, float, double) {
    const TrunkSkin<S> trunk;
    const BoneTargets<S> bones = trunk.bones();
    for (const double t : {0.2, 0.5, 0.8}) {
        const S width = bones.scale() * S(trunk.anatomy.trunk.half_width(t));
        const S depth = bones.scale() * S(trunk.anatomy.trunk.half_depth(t));
        const auto check = [&](S x, S z, S expected_x, S expected_z) {
            const Vector3<S> target = bones.target(0, trunk.at(S(t), x, z));
            CHECK((target - trunk.at(S(t), expected_x, expected_z)).norm() < rounding<S>);
        };
        check(S(0.16), S(0), width, S(0));
        check(S(0), S(-0.12), S(0), -depth);
        check(S(0.6) * S(2) * width, S(0.8) * S(2) * depth, S(0.6) * width, S(0.8) * depth);
        check(S(0.01), S(0.02), S(0.8 * 0.01), S(0.8 * 0.02));  // inside the tube: a part of the way
        CHECK(std::abs(bones.trunk().height(trunk.at(S(t), S(0.1), S(0.1))) - S(t)) < S(rounding<S>));
        CHECK(bones.trunk().backward(trunk.at(S(t), S(0), S(-0.1))) == doctest::Approx(1));
        CHECK(bones.trunk().backward(trunk.at(S(t), S(0.1), S(0))) == doctest::Approx(0).epsilon(1e-4));
    }
    const Vector3<S> lowest = trunk.centre(S(-0.12));
    const Vector3<S> floor = lowest - bones.scale() * S(0.060) * trunk.up;
    CHECK((bones.target(0, lowest - S(0.15) * trunk.up) - floor).norm() < rounding<S>);
}

TEST_CASE_TEMPLATE("weights blend the bones", S, float, double) {
    TrunkSkin<S> trunk;
    trunk.weights.col(0).setZero();
    trunk.weights(1, 0) = S(1);
    trunk.weights.col(1) = trunk.weights.col(0) * S(0.25);
    trunk.weights(0, 1) = S(0.75);
    const BoneTargets<S> bones = trunk.bones();
    const Vector3<S> point = trunk.at(S(-0.05), S(0.15), S(0.02));
    const Vector3<S> blend = S(0.25) * bones.target(0, point) + S(0.75) * bones.target(2, point);
    CHECK((bones.target(1, point) - blend).norm() < rounding<S>);
    CHECK(bones.targets(trunk.skin).col(1) == bones.target(1, trunk.skin.col(1)));
}

TEST_CASE("targets follow a moved, turned and larger body") {
    const TrunkSkin<double> trunk;
    RandomGenerator random(4);
    const Matrix3<double> R = 1.25 * random_rotation<double>(random);
    const Vector3<double> shift(1, 2, 3);
    TrunkSkin<double> moved = trunk;
    moved.joints = (R * trunk.joints).colwise() + shift;
    moved.skin = (R * trunk.skin).colwise() + shift;
    for (Index v = 0; v < moved.weights.cols(); v += 2) {
        moved.weights.col(v).setZero();
        moved.weights(v % 24, v) = 1;
    }
    TrunkSkin<double> original = trunk;
    original.weights = moved.weights;
    const Matrix3X<double> expected = (R * original.bones().targets(original.skin)).colwise() + shift;
    CHECK((moved.bones().targets(moved.skin) - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a trunk without length or width is refused") {
    TrunkSkin<double> trunk;
    const auto message = [&] {
        try {
            static_cast<void>(trunk.bones());
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    SUBCASE("length") {
        trunk.joints.col(12) = trunk.joints.col(0);
        CHECK(message() == "layered body: joints 0 and 12 of the trunk coincide, expected a distance > 0");
    }
    SUBCASE("width") {
        trunk.joints.col(17) = trunk.joints.col(16) + trunk.up;
        CHECK(message() == "layered body: joints 16 and 17 lie along the trunk, expected a direction across");
    }
}
