// SPDX-License-Identifier: MIT
#include <softtissue/ndg/neural_animation.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/allocation_counter.hpp>
#include <support/limb_model.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <type_traits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

Pose<double> bent_pose() {
    Pose<double> pose = Pose<double>::rest(2);
    pose.rotation_vectors.col(1) << 0.2, -0.1, 0.9;
    return pose;
}

/// A limb with what its animation needs.
struct Scene {
    LayeredLimb<double> limb;
    KinematicTree tree = two_joint_tree();
    Matrix3X<double> joints = Matrix3X<double>::Zero(3, 2);
    PoissonReconstruction<Prism6, double> poisson{
        limb.body.mesh, PrescribedVertices(limb.body.mesh.num_vertices(), limb.body.prescribed)};
    SequentialExecutor executor;

    Scene() { joints(0, 0) = -0.2; }

    std::vector<AffineTransform<double>> transforms(const Pose<double>& pose) const {
        return joint_transforms<double>(tree, joints, pose);
    }

    Matrix3X<double> posed(const NeuralModel<float>& model, const Pose<double>& pose) {
        NeuralAnimation<double, SequentialExecutor> animation(model, limb.body, tree, two_joint_names(), poisson,
                                                              executor);
        Matrix3X<double> x;
        animation.pose_into(pose, transforms(pose), x);
        return x;
    }

    Matrix3X<double> skinned(const Pose<double>& pose) const {
        MatrixX<double> prepared;
        const LinearBlend<double> policy;
        policy.prepare_into(transforms(pose), prepared);
        Matrix3X<double> x = limb.body.mesh.rest_positions;
        for (Index v = 0; v < x.cols(); ++v) {
            x.col(v) = policy.blend(prepared, limb.body.weights.row(v))(x.col(v));
        }
        return x;
    }
};

const std::vector<NetworkOptions> all_variants{
    {}, {.exponential = false}, {.rotation = false}, {.shape_input = false}, {.kind = NetworkKind::vertex}};

}  // namespace

TEST_CASE("a network that predicts nothing leaves Gradient Skinning, or linear blend skinning") {
    Scene scene;
    const Pose<double> pose = bent_pose();
    const Matrix3X<double> skinned = scene.skinned(pose);
    CHECK(scene.posed(random_limb_model<float>({.kind = NetworkKind::vertex}, 0.0), pose) == skinned);
    Matrix3X<double> expected = skinned;
    GradientSkinning<Prism6, double> skinning(scene.poisson, scene.limb.body.mesh, scene.limb.body.weights);
    skinning.solve_into(bone_quaternions<double>(scene.transforms(pose)), expected);
    CHECK((scene.posed(random_limb_model<float>({}, 0.0), pose) - expected).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("when the body turns and moves, so does the prediction") {
    Scene scene;
    RandomGenerator random(3);
    for (const NetworkOptions& options : all_variants) {
        const NeuralModel<float> model = random_limb_model<float>(options, 0.05);
        Pose<double> pose = bent_pose();
        const Matrix3X<double> x = scene.posed(model, pose);
        pose.rotation_vectors.col(0) = 1.7 * random_unit<Vector3<double>>(random);
        pose.translation << 1, -2, 0.5;
        const AffineTransform<double> root = scene.transforms(pose)[0];
        const Matrix3X<double> expected = (root.linear * x).colwise() + root.translation;
        CHECK((scene.posed(model, pose) - expected).cwiseAbs().maxCoeff() < 1e-9);
    }
}

TEST_CASE("bone wrap and cuts follow the skin, whatever the network says") {
    Scene scene;
    for (const NetworkOptions& options : all_variants) {
        const Matrix3X<double> x = scene.posed(random_limb_model<float>(options, 0.3), bent_pose());
        const Matrix3X<double> skinned = scene.skinned(bent_pose());
        CHECK(x.allFinite());
        CHECK(x != skinned);
        for (const std::int32_t v : scene.limb.body.prescribed) {
            CHECK(x.col(v) == skinned.col(v));
        }
    }
}

TEST_CASE("predicted gradients are reported and not inverted; threads change no bit") {
    Scene scene;
    const NeuralModel<float> model = random_limb_model<float>({}, 2.0);
    NeuralAnimation<double, SequentialExecutor> animation(model, scene.limb.body, scene.tree, {}, scene.poisson,
                                                          scene.executor);
    Matrix3X<double> x, again;
    animation.pose_into(bent_pose(), scene.transforms(bent_pose()), x);
    CHECK(animation.smallest_determinant() > 0.0F);
    CHECK(animation.residual_gradients().cols() == scene.limb.body.mesh.num_cells());
    const ThreadExecutor threads(3);
    NeuralAnimation<double, ThreadExecutor> threaded(model, scene.limb.body, scene.tree, {}, scene.poisson, threads);
    threaded.pose_into(bent_pose(), scene.transforms(bent_pose()), again);
    CHECK(again == x);
    const NeuralModel<float> offsets = random_limb_model<float>({.kind = NetworkKind::vertex}, 1.0);
    NeuralAnimation<double, SequentialExecutor> vertices(offsets, scene.limb.body, scene.tree, {}, scene.poisson,
                                                         scene.executor);
    CHECK_THROWS_AS(vertices.smallest_determinant(), InvalidInput);
}

TEST_CASE("weights in fewer bytes change a pose a little, and threads change no bit of it") {
    Scene scene;
    const NeuralModel<float> model = random_limb_model<float>({}, 0.5);
    const Pose<double> pose = bent_pose();
    const Matrix3X<double> expected = scene.posed(model, pose);
    std::vector<Pose<double>> typical(20, pose);
    for (size_t k = 0; k < typical.size(); ++k) {
        typical[k].rotation_vectors *= 0.1 * double(k);
    }
    const MatrixX<float> inputs = network_inputs<float, double>(
        model, scene.tree, typical, shape_input(model, scene.limb.body.mesh.rest_positions));
    const double size = (expected - scene.posed(random_limb_model<float>({}, 0.0), pose)).norm();
    for (const WeightFormat format : {WeightFormat::bfloat16, WeightFormat::int8, WeightFormat::int4}) {
        const QuantizedMlp<float> small(model.mlp, format, inputs);
        const auto posed = [&](const auto& executor) {
            NeuralAnimation<double, std::remove_cvref_t<decltype(executor)>> animation(
                model, scene.limb.body, scene.tree, {}, scene.poisson, executor, &small);
            Matrix3X<double> x;
            animation.pose_into(pose, scene.transforms(pose), x);
            return x;
        };
        const Matrix3X<double> x = posed(scene.executor);
        CHECK(posed(ThreadExecutor(3)) == x);
        const double difference = (x - expected).norm() / size;
        CHECK(difference > 0.0);
        CHECK(difference < (format == WeightFormat::int4 ? 0.05 : 0.01));
    }
}

TEST_CASE("gradient models allocate nothing after the first pose") {
    Scene scene;
    const auto transforms = scene.transforms(bent_pose());
    for (const NetworkOptions& options : all_variants) {
        if (options.kind == NetworkKind::vertex) {
            continue;
        }
        const NeuralModel<float> model = random_limb_model<float>(options, 0.5);
        const QuantizedMlp<float> small(model.mlp, WeightFormat::int8);
        for (const QuantizedMlp<float>* const weights : {static_cast<const QuantizedMlp<float>*>(nullptr), &small}) {
            NeuralAnimation<double, SequentialExecutor> animation(model, scene.limb.body, scene.tree, {}, scene.poisson,
                                                                  scene.executor, weights);
            const Pose<double> pose = bent_pose();
            Matrix3X<double> x;
            animation.pose_into(pose, transforms, x);
            const AllocationCounter counter;
            animation.pose_into(pose, transforms, x);
            CHECK(counter.count() == 0);
        }
    }
}

TEST_CASE("the shape reaches the network, unless it is taken away") {
    Scene usual, thick;
    thick.limb.body.mesh.rest_positions.row(1) *= 1.2;
    thick.limb.body.mesh.rest_positions.row(2) *= 1.2;
    for (const bool shape_input : {true, false}) {
        const NeuralModel<float> model = random_limb_model<float>({.shape_input = shape_input}, 0.5);
        const auto residuals = [&](Scene& scene) {
            NeuralAnimation<double, SequentialExecutor> animation(model, scene.limb.body, scene.tree, {}, scene.poisson,
                                                                  scene.executor);
            Matrix3X<double> x;
            animation.pose_into(bent_pose(), scene.transforms(bent_pose()), x);
            return animation.residual_gradients();
        };
        CHECK((residuals(usual) == residuals(thick)) == !shape_input);
    }
}

TEST_CASE("another body, another skeleton and poses that are none are refused") {
    Scene scene;
    const NeuralModel<float> model = random_limb_model<float>({}, 0.5);
    using Animation = NeuralAnimation<double, SequentialExecutor>;
    CHECK_THROWS_WITH_AS(
        Animation(model, scene.limb.body, scene.tree, {"lower", "upper"}, scene.poisson, scene.executor),
        "neural model 'random': made for a body whose joint 0 is 'upper', here it is 'lower'", InvalidInput);
    LayeredBody<double> other = scene.limb.body;
    other.prescribed.pop_back();
    CHECK_THROWS_AS(Animation(model, other, scene.tree, {}, scene.poisson, scene.executor), InvalidInput);
    other.mesh.cells.conservativeResize(6, 300);
    CHECK_THROWS_WITH_AS(
        Animation(model, other, scene.tree, {}, scene.poisson, scene.executor),
        "neural model 'random': made for a body of 300 vertices and 360 cells, this one has 300 and 300", InvalidInput);
    Animation animation(model, scene.limb.body, scene.tree, {}, scene.poisson, scene.executor);
    Matrix3X<double> x;
    Pose<double> pose = bent_pose();
    const auto transforms = scene.transforms(pose);
    pose.rotation_vectors(2, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(animation.pose_into(pose, transforms, x),
                         "pose features: the rotation vector of joint 1 is not finite", InvalidInput);
    CHECK_THROWS_WITH_AS(animation.pose_into(bent_pose(), std::span(transforms).first(1), x),
                         "neural animation: 1 joint transforms, expected 2", InvalidInput);
}
