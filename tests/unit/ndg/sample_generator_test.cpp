// SPDX-License-Identifier: MIT
#include <softtissue/ndg/sample_generator.hpp>

#include <softtissue/ndg/layered_animation.hpp>

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

namespace {

Pose<double> bent_pose(double angle) {
    Pose<double> pose = Pose<double>::rest(2);
    pose.rotation_vectors.col(1) << 0.3 * angle, 0, angle;
    return pose;
}

}  // namespace

TEST_CASE("a sample is the equilibrium that an animation by the reference finds") {
    const ShapedBody<double> limb = LimbMaker()(VectorX<double>::Constant(2, 0.4));
    SampleGenerator<double> generator(limb, limb_tree(), sample_options<double>());
    const GeneratedSample<double> sample = generator.generate(bent_pose(0.8));
    REQUIRE(sample.succeeded());
    CHECK(sample.report.decrement <= sample_options<double>().newton.decrement_tolerance);
    CHECK(sample.num_inverted == 0);
    CHECK(sample.report.energy > sample.rest_energy);

    const SequentialExecutor executor;
    LayeredAnimation<double, SequentialExecutor> animation(limb.layered, {}, executor);
    Matrix3X<double> x;
    const auto transforms = joint_transforms<double>(limb_tree(), limb.joints, bent_pose(0.8));
    CHECK(animation.pose_into(AnimationMethod::fem, transforms, x, sample_options<double>().newton).succeeded());
    CHECK((x - sample.positions).cwiseAbs().maxCoeff() < 1e-12);

    // The same bits, whatever was generated before.
    CHECK(generator.generate(bent_pose(-0.3)).succeeded());
    CHECK(generator.generate(bent_pose(0.8)).positions == sample.positions);
}

TEST_CASE("the tolerance of samples leaves errors far below those of any method that learns from them") {
    const ShapedBody<double> limb = LimbMaker()(VectorX<double>::Zero(2));
    SampleOptions<double> tight = sample_options<double>();
    tight.newton.decrement_tolerance = 1e-12;
    SampleGenerator<double> generator(limb, limb_tree(), sample_options<double>());
    SampleGenerator<double> exact(limb, limb_tree(), tight);
    const Matrix3X<double> difference =
        generator.generate(bent_pose(1.0)).positions - exact.generate(bent_pose(1.0)).positions;
    CHECK(difference.colwise().norm().mean() < 2e-5);
}

TEST_CASE("a solve that ends without equilibrium is a failure with its reason") {
    const ShapedBody<double> limb = LimbMaker()(VectorX<double>::Zero(2));
    SampleOptions<double> options = sample_options<double>();
    options.newton.max_iterations = 1;
    SampleGenerator<double> generator(limb, limb_tree(), options);
    const GeneratedSample<double> sample = generator.generate(bent_pose(1.0));
    CHECK(!sample.succeeded());
    CHECK(sample.failure == "no equilibrium: iteration limit reached");
}
