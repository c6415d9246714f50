// SPDX-License-Identifier: MIT
// Skinning kernels on a generated tube body of SMPL's size and sparsity; and the same body by dense arrays.

#include "machine_limits.hpp"

#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

using namespace softtissue;

constexpr Index num_joints = 24;

/// A chain of 24 joints along x; three to four joints a vertex, 4 % of the pose blend shapes not zero.
template <class S>
SmplBody<S> chain_body(Index num_vertices) {
    RandomGenerator random(1);
    SmplBody<S> body;
    std::vector<std::int32_t> parents;
    for (std::int32_t j = 0; j < num_joints; ++j) {
        parents.push_back(j - 1);
    }
    body.tree = KinematicTree(parents);
    body.template_vertices.resize(3, num_vertices);
    MatrixX<S> weights(num_vertices, num_joints);
    std::vector<Eigen::Triplet<S>> regressor, directions;
    for (Index v = 0; v < num_vertices; ++v) {
        const double x = double(v) * double(num_joints - 1) / double(num_vertices - 1);
        body.template_vertices.col(v) << S(0.07 * x), S(0.1 * random.normal()), S(0.1 * random.normal());
        for (Index j = 0; j < num_joints; ++j) {
            const S distance = S(std::abs(x - double(j)));
            weights(v, j) = distance < S(1.75) ? S(1.75) - distance : S(0);
        }
        weights.row(v) /= weights.row(v).sum();
        regressor.emplace_back(int(std::lround(x)), int(v), S(double(num_joints) / double(num_vertices)));
        for (int c = 0; c < 9 * (num_joints - 1); ++c) {
            if (std::abs(x - double(c) / 9 - 1) < 0.5) {
                for (int d = 0; d < 3; ++d) {
                    directions.emplace_back(int(3 * v) + d, c, S(0.01 * random.normal()));
                }
            }
        }
    }
    body.weights = SkinningWeights<S>(weights);
    body.joint_regressor.resize(num_joints, num_vertices);
    body.joint_regressor.setFromTriplets(regressor.begin(), regressor.end());
    body.shape_directions = MatrixX<S>::Zero(3 * num_vertices, 10);
    body.pose_directions.resize(3 * num_vertices, 9 * (num_joints - 1));
    body.pose_directions.setFromTriplets(directions.begin(), directions.end());
    return body;
}

template <class S>
Pose<S> walking_pose() {
    RandomGenerator random(2);
    Pose<S> pose = Pose<S>::rest(num_joints);
    for (Index j = 0; j < num_joints; ++j) {
        pose.rotation_vectors.col(j) = S(0.3) * random_unit<Vector3<S>>(random);
    }
    return pose;
}

template <class S>
void count_vertices(benchmark::State& state, double bytes_read = 0, double bytes_written = 0) {
    benchmarks::count_work<S>(state, {.unit = "vertices",
                                      .items = double(state.range(0)),
                                      .bytes_read = bytes_read,
                                      .bytes_written = bytes_written});
}

/// All of the SMPL function: pose blend shapes, blends, posed vertices.
template <class Policy>
void pose_body(benchmark::State& state) {
    using S = typename Policy::Scalar;
    const VolumetricSmpl<S, Policy> model(chain_body<S>(state.range(0)));
    const Pose<S> pose = walking_pose<S>();
    PosedBody<S> posed = model.pose(pose);
    for (auto _ : state) {
        model.pose_into(pose, posed);
        benchmark::DoNotOptimize(posed.positions.data());
        benchmark::ClobberMemory();
    }
    // rest vertices and four weights each; transforms, offsets and positions
    const double vertices = double(state.range(0)), number = double(sizeof(S));
    count_vertices<S>(state, double(model.pose_blend_shapes().num_bytes()) + vertices * (3 * number + 4 * (number + 4)),
                      vertices * 18 * number);
}

/// Points by weights and joints, no more.
template <class Policy>
void skin_points(benchmark::State& state) {
    using S = typename Policy::Scalar;
    const SmplBody<S> body = chain_body<S>(state.range(0));
    const auto joints = joint_transforms(body.tree, VolumetricSmpl<S>(body).rest_joints(), walking_pose<S>());
    MatrixX<S> prepared;
    Matrix3X<S> x;
    for (auto _ : state) {
        skin_points_into(Policy(), joints, body.weights, body.template_vertices, prepared, x);
        benchmark::DoNotOptimize(x.data());
        benchmark::ClobberMemory();
    }
    const double vertices = double(state.range(0)), number = double(sizeof(S));
    count_vertices<S>(state, vertices * (3 * number + 4 * (number + 4)), vertices * 3 * number);
}

/// Sums over all joints for one vertex after the other, as the definition reads.
template <class S>
Matrix3X<S> naive_linear_blend(const MatrixX<S>& weights, const std::vector<AffineTransform<S>>& joints,
                               const Matrix3X<S>& rest) {
    Matrix3X<S> x(3, rest.cols());
    for (Index v = 0; v < rest.cols(); ++v) {
        AffineTransform<S> T{Matrix3<S>::Zero(), Vector3<S>::Zero()};
        for (Index j = 0; j < num_joints; ++j) {
            T.linear += weights(v, j) * joints[size_t(j)].linear;
            T.translation += weights(v, j) * joints[size_t(j)].translation;
        }
        x.col(v) = T(rest.col(v));
    }
    return x;
}

template <class S>
void naive_linear_skinning(benchmark::State& state) {
    const SmplBody<S> body = chain_body<S>(state.range(0));
    const auto joints = joint_transforms(body.tree, VolumetricSmpl<S>(body).rest_joints(), walking_pose<S>());
    const MatrixX<S> weights = body.weights.dense();
    for (auto _ : state) {
        benchmark::DoNotOptimize(naive_linear_blend<S>(weights, joints, body.template_vertices));
    }
    count_vertices<S>(state);
}

template <class S>
void naive_dual_quaternions(benchmark::State& state) {
    const SmplBody<S> body = chain_body<S>(state.range(0));
    const auto joints = joint_transforms(body.tree, VolumetricSmpl<S>(body).rest_joints(), walking_pose<S>());
    const MatrixX<S> weights = body.weights.dense();
    MatrixX<S> prepared;
    Matrix3X<S> x(3, state.range(0));
    for (auto _ : state) {
        DualQuaternion<S>().prepare_into(joints, prepared);
        for (Index v = 0; v < x.cols(); ++v) {
            Index pivot = 0;
            weights.row(v).maxCoeff(&pivot);
            Eigen::Matrix<S, 8, 1> sum = Eigen::Matrix<S, 8, 1>::Zero();
            for (Index j = 0; j < num_joints; ++j) {
                const bool flipped =
                    prepared.col(j).template head<4>().dot(prepared.col(pivot).template head<4>()) < S(0);
                sum += (flipped ? -weights(v, j) : weights(v, j)) * prepared.col(j);
            }
            sum /= sum.template head<4>().norm();
            const Quaternion<S> q = sum.template head<4>(), e = sum.template tail<4>();
            const Quaternion<S> t = quaternion_product<S>(e, Quaternion<S>(q(0), -q(1), -q(2), -q(3)));
            x.col(v) =
                rotation_matrix_from_quaternion<S>(q) * body.template_vertices.col(v) + S(2) * t.template tail<3>();
        }
        benchmark::DoNotOptimize(x.data());
        benchmark::ClobberMemory();
    }
    count_vertices<S>(state);
}

/// Dense weights and dense pose blend shapes.
template <class S>
void naive_pose_body(benchmark::State& state) {
    const SmplBody<S> body = chain_body<S>(state.range(0));
    const VolumetricSmpl<S> model(body);
    const MatrixX<S> weights = body.weights.dense(), directions = body.pose_directions.toDense();
    const Pose<S> pose = walking_pose<S>();
    VectorX<S> features(9 * (num_joints - 1)), offsets(3 * state.range(0));
    Matrix3X<S> shaped(3, state.range(0));
    for (auto _ : state) {
        const auto joints = joint_transforms(body.tree, model.rest_joints(), pose);
        for (Index j = 1; j < num_joints; ++j) {
            const Matrix3<S> transposed = local_rotation(pose, j).transpose() - Matrix3<S>::Identity();
            features.template segment<9>(9 * (j - 1)) = vec<S>(transposed);
        }
        offsets.noalias() = directions * features;
        shaped = model.rest_vertices() + Eigen::Map<const Matrix3X<S>>(offsets.data(), 3, shaped.cols());
        benchmark::DoNotOptimize(naive_linear_blend<S>(weights, joints, shaped));
    }
    count_vertices<S>(state);
}

template <class S>
void unpose_body(benchmark::State& state) {
    const VolumetricSmpl<S> model(chain_body<S>(state.range(0)));
    const PosedBody<S> posed = model.pose(walking_pose<S>());
    Matrix3X<S> u(3, state.range(0));
    for (auto _ : state) {
        unposed_into(posed, posed.positions, u);
        benchmark::DoNotOptimize(u.data());
        benchmark::ClobberMemory();
    }
    count_vertices<S>(state);
}

template <class Policy>
void check_body(benchmark::State& state) {
    using S = typename Policy::Scalar;
    const VolumetricSmpl<S, Policy> model(chain_body<S>(state.range(0)));
    const PosedBody<S> posed = model.pose(walking_pose<S>());
    for (auto _ : state) {
        benchmark::DoNotOptimize(check_blends<S>(posed.transforms));
    }
    count_vertices<S>(state);
}

template <class S>
void blend_rotations(benchmark::State& state) {
    const VolumetricSmpl<S> model(chain_body<S>(state.range(0)));
    const BlendedRotations<S> blended(model.weights());
    const PosedBody<S> posed = model.pose(walking_pose<S>());
    const std::vector<Quaternion<S>> bones = bone_quaternions<S>(posed.joint_transforms);
    std::vector<Matrix3<S>> rotations = blended.rotations(posed.joint_transforms);
    for (auto _ : state) {
        blended.rotations_into(bones, rotations);
        benchmark::DoNotOptimize(rotations.data());
        benchmark::ClobberMemory();
    }
    count_vertices<S>(state);
}

constexpr Index smpl_size = 6890, volume_size = 12303, large_size = 50000;

}  // namespace

BENCHMARK(skin_points<LinearBlend<float>>)->Name("14 linear blend skinning/float")->Arg(volume_size);
BENCHMARK(skin_points<LinearBlend<double>>)->Name("14 linear blend skinning/double")->Arg(volume_size);
BENCHMARK(naive_linear_skinning<float>)
    ->Name("14 linear blend skinning/baseline Eigen loop with dense weights, float")
    ->Arg(volume_size);
BENCHMARK(naive_linear_skinning<double>)
    ->Name("14 linear blend skinning/baseline Eigen loop with dense weights, double")
    ->Arg(volume_size);
BENCHMARK(skin_points<DualQuaternion<float>>)->Name("14 dual quaternion skinning/float")->Arg(volume_size);
BENCHMARK(skin_points<DualQuaternion<double>>)->Name("14 dual quaternion skinning/double")->Arg(volume_size);
BENCHMARK(naive_dual_quaternions<float>)
    ->Name("14 dual quaternion skinning/baseline Eigen loop with dense weights, float")
    ->Arg(volume_size);
BENCHMARK(naive_dual_quaternions<double>)
    ->Name("14 dual quaternion skinning/baseline Eigen loop with dense weights, double")
    ->Arg(volume_size);
BENCHMARK(pose_body<LinearBlend<float>>)->Name("14 volumetric SMPL/float")->Arg(volume_size);
BENCHMARK(pose_body<LinearBlend<double>>)->Name("14 volumetric SMPL/double")->Arg(volume_size);
BENCHMARK(naive_pose_body<float>)->Name("14 volumetric SMPL/baseline dense arrays, float")->Arg(volume_size);
BENCHMARK(naive_pose_body<double>)->Name("14 volumetric SMPL/baseline dense arrays, double")->Arg(volume_size);
BENCHMARK(pose_body<DualQuaternion<float>>)->Name("posing with dual quaternions/float")->Arg(volume_size);
BENCHMARK(pose_body<DualQuaternion<double>>)
    ->Name("posing with dual quaternions/double")
    ->Arg(volume_size)
    ->Arg(large_size);
BENCHMARK(unpose_body<float>)->Name("unposing a body/float")->Arg(smpl_size);
BENCHMARK(unpose_body<double>)->Name("unposing a body/double")->Arg(smpl_size);
BENCHMARK(check_body<LinearBlend<double>>)->Name("checking blends/linear, double")->Arg(smpl_size);
BENCHMARK(check_body<DualQuaternion<double>>)->Name("checking blends/dual quaternions, double")->Arg(smpl_size);
BENCHMARK(blend_rotations<float>)->Name("blended rotations/float")->Arg(smpl_size);
BENCHMARK(blend_rotations<double>)->Name("blended rotations/double")->Arg(smpl_size)->Arg(large_size);
