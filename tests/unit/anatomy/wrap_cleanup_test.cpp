// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/wrap_cleanup.hpp>

#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace softtissue;

namespace {

template <class S>
struct CleanupCapsule {
    CapsuleBody<S> capsule;
    TriangleMesh mesh{capsule.faces, capsule.positions.cols()};
    const Matrix3X<S>& skin = capsule.positions;
    Matrix3X<S> targets = skin;
    VectorX<S> fat = VectorX<S>::Constant(skin.cols(), S(0.015));

    CleanupCapsule() {
        for (Index v = 0; v < skin.cols(); ++v) {
            const Vector3<S> axis(S(0), std::clamp(skin(1, v), S(0.1), S(0.9)), S(0));
            targets.col(v) = axis + S(0.5) * (skin.col(v) - axis);
        }
    }

    int improve(Matrix3X<S>& bone, Matrix3X<S>& muscle, const WrapCleanupOptions<S>& options = {}) const {
        return WrapCleanup<S>(mesh, skin, targets, fat, options).improve(bone, muscle);
    }

    S smallest_coefficient(const Matrix3X<S>& lower, const Matrix3X<S>& upper) const {
        const Matrix3X<S> inverse_sines = inverse_corner_sines(skin, capsule.faces);
        S smallest(1);
        for (Index t = 0; t < capsule.faces.cols(); ++t) {
            const Prism6::Nodes<S> X = nodes_between(capsule.faces, t, lower, upper);
            smallest = std::min(smallest, relative_coefficients<S>(X, inverse_sines.col(t)).minCoeff());
        }
        return smallest;
    }
};

}  // namespace

TEST_CASE("the fat fraction is bounded") {
    CHECK(fat_fraction(0.01, 0.04, 0.45) == 0.25);
    CHECK(fat_fraction(0.04, 0.05, 0.45) == 0.45);
}

TEST_CASE_TEMPLATE("good prisms come to rest at target and fraction", S, float, double) {
    const CleanupCapsule<S> body;
    Matrix3X<S> bone = body.targets + S(0.1) * (body.skin - body.targets);
    Matrix3X<S> muscle = (body.skin + bone) / S(2);
    const int sweeps = body.improve(bone, muscle);
    CHECK(sweeps > 1);
    CHECK(sweeps < 30);
    // The sweeps end when none moves by 0.1 mm; the smoothing term lets errors vanish by a third a sweep or faster.
    CHECK((bone - body.targets).colwise().norm().maxCoeff() < S(4e-4));
    CHECK(((muscle - body.skin).colwise().norm().array() - S(0.015)).abs().maxCoeff() < S(1e-4));
}

TEST_CASE_TEMPLATE("bad prisms become better and none is lost", S, float, double) {
    const CleanupCapsule<S> body;
    RandomGenerator random(8);
    Matrix3X<S> bone = body.targets;
    // Noise as strong as the prisms bear.
    for (Index v = 0; v < bone.cols(); ++v) {
        const Vector3<S> before = bone.col(v);
        bone.col(v) += S(0.008) * random_normal<Vector3<S>>(random);
        if (body.smallest_coefficient(bone, body.skin) < S(0.02)) {
            bone.col(v) = before;
        }
    }
    Matrix3X<S> muscle = S(0.7) * body.skin + S(0.3) * bone;
    const S before = std::min(body.smallest_coefficient(bone, muscle), body.smallest_coefficient(muscle, body.skin));
    CHECK(before > S(0));
    CHECK(before < S(0.1));
    Matrix3X<S> again_bone = bone;
    Matrix3X<S> again_muscle = muscle;
    body.improve(bone, muscle);
    CHECK(body.smallest_coefficient(bone, muscle) > S(0.3));
    CHECK(body.smallest_coefficient(muscle, body.skin) > S(0.3));
    body.improve(again_bone, again_muscle);
    CHECK(again_bone == bone);
    CHECK(again_muscle == muscle);
}

TEST_CASE_TEMPLATE("no layer vanishes, whatever is wanted", S, float, double) {
    CleanupCapsule<S> body;
    body.fat.setConstant(S(1e-6));
    const auto thinnest_fat = [&](const WrapCleanupOptions<S>& options) {
        Matrix3X<S> bone = body.targets;
        Matrix3X<S> muscle = (body.skin + bone) / S(2);
        body.improve(bone, muscle, options);
        return (body.skin - muscle).colwise().norm().minCoeff();
    };
    CHECK(thinnest_fat({}) > S(0.001));
    CHECK(thinnest_fat({.short_column = S(0)}) < S(1e-5));
}
