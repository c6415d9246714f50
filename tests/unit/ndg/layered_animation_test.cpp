// SPDX-License-Identifier: MIT
#include <softtissue/ndg/layered_animation.hpp>

#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/testing/random_states.hpp>

#include <reliability/random_pose.hpp>
#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("a rigid motion of all joints is a rigid motion of the limb, by every method") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredAnimation<double, SequentialExecutor> animation(limb.body, {}, executor);
    RandomGenerator random(5);
    std::vector<AffineTransform<double>> transforms(2);
    transforms[0] = transforms[1] = {random_rotation<double>(random), Vector3<double>(1, -2, 0.5)};
    const Matrix3X<double> expected =
        (transforms[0].linear * limb.body.mesh.rest_positions).colwise() + transforms[0].translation;
    for (const AnimationMethod method : all_animation_methods) {
        Matrix3X<double> x;
        CAPTURE(to_string(method));
        CHECK(animation.pose_into(method, transforms, x).succeeded());
        CHECK((x - expected).cwiseAbs().maxCoeff() < 1e-9);
    }
}

TEST_CASE("a solve that runs out of iterations says so and makes the start suspicious") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredAnimation<double, SequentialExecutor> animation(limb.body, {}, executor);
    const auto transforms = limb.transforms(1.2);
    NewtonOptions<double> options = quasi_static_options<double>();
    options.max_iterations = 1;
    Matrix3X<double> x;
    CHECK(animation.pose_into(AnimationMethod::fem, transforms, x, options).status == SolveStatus::iteration_limit);
    CHECK(std::isinf(animation.start_dependence(transforms, x, options)));
}

TEST_CASE("joint transforms that are not finite are refused by every method") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredAnimation<double, SequentialExecutor> animation(limb.body, {}, executor);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto transforms = limb.transforms(0.5);
        transforms[1].translation(1) = bad;
        for (const AnimationMethod method : all_animation_methods) {
            CAPTURE(to_string(method));
            Matrix3X<double> x;
            CHECK_THROWS_WITH_AS(static_cast<void>(animation.pose_into(method, transforms, x)),
                                 "skinning: transform of joint 1 is not finite", InvalidInput);
        }
        transforms[1] = {};
        transforms[1].linear(0, 1) = bad;
        CHECK_THROWS_WITH_AS(static_cast<void>(animation.blended_rotations(transforms)),
                             "blended rotations: quaternion of joint 1 is not finite", InvalidInput);
    }
}

TEST_CASE("any pose, far beyond what joints do, gives finite positions by every method") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredAnimation<double, SequentialExecutor> animation(limb.body, {}, executor);
    const KinematicTree tree({KinematicTree::no_parent, 0});
    for (std::uint64_t k = 0; k < 8; ++k) {
        RandomGenerator random(k);
        const auto transforms =
            joint_transforms<double>(tree, Matrix3X<double>::Zero(3, 2), reliability::random_pose<double>(2, random));
        for (const AnimationMethod method : all_animation_methods) {
            CAPTURE(to_string(method));
            Matrix3X<double> x;
            CHECK(animation.pose_into(method, transforms, x).iterations <= 100);
            CHECK(x.allFinite());
        }
    }
}
