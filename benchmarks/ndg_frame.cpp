// SPDX-License-Identifier: MIT
// A frame of neural animation at the paper's size: network, exponentials, rotations, right-hand side, triangular solves,
// and 134,000 embedded vertices, of a limb of 53,248 prisms on 94 joints; beside it each part alone.

#include "machine_limits.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/ndg/network_input.hpp>
#include <softtissue/ndg/neural_animation.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace softtissue;

constexpr Index around = 64, along = 209, num_joints = 94, num_points = 134000;

/// A tube of two layers of prisms around a bone, bent by joints along it.
LayeredBody<float> make_limb() {
    LayeredBody<float> body;
    body.layers.num_columns = around * along;
    Triangles& triangles = body.region.triangles;
    triangles.resize(3, 2 * around * (along - 1));
    for (Index j = 0, t = 0; j + 1 < along; ++j) {
        for (Index i = 0; i < around; ++i, t += 2) {
            const auto column = [&](Index x, Index y) { return std::int32_t(y * around + x % around); };
            triangles.col(t) << column(i, j), column(i + 1, j), column(i, j + 1);
            triangles.col(t + 1) << column(i + 1, j), column(i + 1, j + 1), column(i, j + 1);
        }
    }
    body.mesh.cells = body.layers.prisms(triangles);
    body.mesh.rest_positions.resize(3, body.layers.num_vertices());
    MatrixX<float> weights = MatrixX<float>::Zero(body.layers.num_vertices(), num_joints);
    for (Index c = 0; c < body.num_columns(); ++c) {
        const float angle = 2 * std::numbers::pi_v<float> * float(c % around) / float(around);
        const float place = float(c / around) / float(along - 1);
        for (Index level = 0; level < 3; ++level) {
            const Index v = body.layers.vertex(c, level);
            const float radius = 0.03F + 0.01F * float(level);
            body.mesh.rest_positions.col(v) << radius * std::cos(angle), radius * std::sin(angle), 0.8F * place;
            for (Index j = 0; j < num_joints; ++j) {
                const float steps = place * float(num_joints - 1) - float(j);
                weights(v, j) = std::max(0.0F, 1 - steps * steps / 4);
            }
            weights.row(v) /= weights.row(v).sum();
            if (level == 0) {
                body.prescribed.push_back(std::int32_t(v));
            }
        }
    }
    body.weights = SkinningWeights<float>(weights);
    body.skin_offsets = Matrix3X<float>::Zero(3, body.num_columns());
    return body;
}

KinematicTree chain() {
    std::vector<std::int32_t> parents;
    for (Index j = 0; j < num_joints; ++j) {
        parents.push_back(std::int32_t(j) - 1);
    }
    parents[0] = KinematicTree::no_parent;
    return KinematicTree(parents);
}

Pose<float> random_pose(RandomGenerator& random) {
    Pose<float> pose = Pose<float>::rest(num_joints);
    for (float& angle : pose.rotation_vectors.reshaped()) {
        angle = float(random.uniform(-0.02, 0.02));
    }
    return pose;
}

/// Points in random prisms, as a mesh that was made on its own has them: neighbours mostly in order.
Matrix3X<float> random_points(const CellMesh<Prism6, float>& mesh) {
    RandomGenerator random(2);
    Matrix3X<float> points(3, num_points);
    for (Index p = 0; p < num_points; ++p) {
        const auto X = mesh.rest_nodes(p * mesh.num_cells() / num_points);
        const float a = float(random.uniform(0.1, 0.4)), b = float(random.uniform(0.1, 0.4)),
                    t = float(random.uniform());
        const Vector3<float> low = a * X.col(0) + b * X.col(1) + (1 - a - b) * X.col(2);
        const Vector3<float> high = a * X.col(3) + b * X.col(4) + (1 - a - b) * X.col(5);
        points.col(p) = (1 - t) * low + t * high;
    }
    return points;
}

/// Everything that does not change from frame to frame.
struct Scene {
    LayeredBody<float> body = make_limb();
    KinematicTree tree = chain();
    PoissonReconstruction<Prism6, float> poisson{body.mesh,
                                                 PrescribedVertices(body.mesh.num_vertices(), body.prescribed)};
    Embedding<float> embedding{random_points(body.mesh), body.mesh};
    NeuralModel<float> model{
        "random",
        {.shape_input = false},
        Mlp<float>({.inputs = 9 * (num_joints - 1), .hidden = {4096, 4096, 600}, .outputs = 9 * body.mesh.num_cells()}),
        {},
        body_identity(body, tree),
        {}};
    std::vector<Pose<float>> poses;
    std::vector<std::vector<AffineTransform<float>>> transforms;

    Scene() {
        model.mlp.initialize(1, 0.1F);
        RandomGenerator random(3);
        Matrix3X<double> joints = Matrix3X<double>::Zero(3, num_joints);
        joints.row(2) = VectorX<double>::LinSpaced(num_joints, 0.0, 0.8).transpose();
        for (int k = 0; k < 200; ++k) {
            poses.push_back(random_pose(random));
            transforms.push_back(joint_transforms<float>(tree, joints.cast<float>(), poses.back()));
        }
    }
};

Scene& scene() {
    static Scene result;
    return result;
}

template <WeightFormat format>
const QuantizedMlp<float>* weights_of_format() {
    if constexpr (format == WeightFormat::full) {
        return nullptr;
    } else {
        static const QuantizedMlp<float> network(
            scene().model.mlp, format,
            network_inputs<float, float>(scene().model, scene().tree, scene().poses, VectorX<float>(0)),
            ThreadExecutor(2));
        return &network;
    }
}

/// Argument: threads.
template <WeightFormat format>
void frame(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    NeuralAnimation<float, ThreadExecutor> animation(s.model, s.body, s.tree, {}, s.poisson, executor,
                                                     weights_of_format<format>());
    Matrix3X<float> x, points(3, num_points);
    size_t pose = 0;
    for (auto _ : state) {
        animation.pose_into(s.poses[pose], s.transforms[pose], x);
        s.embedding.apply_into(x, points, executor);
        pose = (pose + 1) % s.poses.size();
        benchmark::DoNotOptimize(points.data());
        benchmark::ClobberMemory();
    }
    state.counters["frames/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}

template <WeightFormat format>
void network_part(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    NetworkInference<float> network(s.model.mlp, weights_of_format<format>());
    const VectorX<float> input = VectorX<float>::Constant(s.model.mlp.sizes().inputs, 0.1F);
    MatrixX<float> output(s.model.mlp.sizes().outputs, 1);
    for (auto _ : state) {
        network.infer_into(input, output, executor);
        benchmark::ClobberMemory();
    }
}

Matrix9X<float> random_logarithms() {
    RandomGenerator random(1);
    return Matrix9X<float>::NullaryExpr(9, scene().body.mesh.num_cells(),
                                        [&random] { return float(random.uniform(-0.1, 0.1)); });
}

void targets_in_one_pass(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    const GradientSkinning<Prism6, float> skinning(s.poisson, s.body.mesh, s.body.weights);
    const Matrix9X<float> Q = random_logarithms();
    Matrix9X<float> F = Q;
    Matrix3X<float> targets;
    for (auto _ : state) {
        rotated_exponentials_into<float, float>(Q, skinning.blended(), bone_quaternions<float>(s.transforms[0]), F,
                                                targets, executor);
        benchmark::ClobberMemory();
    }
}

void targets_in_three_passes(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    GradientSkinning<Prism6, float> skinning(s.poisson, s.body.mesh, s.body.weights);
    const Matrix9X<float> Q = random_logarithms();
    MatrixX<float> F = Q;
    Matrix3X<float> targets;
    for (auto _ : state) {
        matrix_exponentials_into<float>(Q, F, executor);
        target_gradients_into<float, float>(F, skinning.rotations(bone_quaternions<float>(s.transforms[0]), executor),
                                            targets, executor);
        benchmark::ClobberMemory();
    }
}

void skinning_part(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    MatrixX<float> prepared;
    Matrix3X<float> x;
    for (auto _ : state) {
        skin_points_into(LinearBlend<float>(), std::span<const AffineTransform<float>>(s.transforms[0]), s.body.weights,
                         s.body.mesh.rest_positions, prepared, x, executor);
        benchmark::ClobberMemory();
    }
}

void reconstruction_part(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    const Matrix3X<float> targets = Matrix3<float>::Identity().replicate(1, s.body.mesh.num_cells());
    Matrix3X<float> x = s.body.mesh.rest_positions;
    for (auto _ : state) {
        s.poisson.solve_into(targets, x, executor);
        benchmark::ClobberMemory();
    }
}

void embedding_part(benchmark::State& state) {
    Scene& s = scene();
    const ThreadExecutor executor(int(state.range(0)));
    Matrix3X<float> points(3, num_points);
    for (auto _ : state) {
        s.embedding.apply_into(s.body.mesh.rest_positions, points, executor);
        benchmark::ClobberMemory();
    }
}

bool add(const std::string& name, void (*function)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name.c_str(), function)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
    return true;
}

const std::string whole = "16 frame of neural animation at the paper's size/", part = "16 parts of a frame/",
                  targets = "16 target gradients of a frame/";
[[maybe_unused]] const bool is_added =
    add(whole + "baseline full weights", frame<WeightFormat::full>) &&
    add(whole + "bfloat16", frame<WeightFormat::bfloat16>) && add(whole + "int8", frame<WeightFormat::int8>) &&
    add(whole + "int4", frame<WeightFormat::int4>) && add(part + "network, int8", network_part<WeightFormat::int8>) &&
    add(part + "network, int4", network_part<WeightFormat::int4>) &&
    add(targets + "in one pass", targets_in_one_pass) &&
    add(targets + "baseline exponentials, rotations and products one after the other", targets_in_three_passes) &&
    add(part + "skinning", skinning_part) && add(part + "right-hand side and solves", reconstruction_part) &&
    add(part + "embedding", embedding_part);

}  // namespace
