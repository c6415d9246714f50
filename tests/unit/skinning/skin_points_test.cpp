// SPDX-License-Identifier: MIT
#include <softtissue/skinning/skin_points.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// Four points between two joints, the second turned and moved.
template <class S>
struct Example {
    Matrix3X<S> rest = (Matrix3X<S>(3, 4) << 0, 1, 2, 3, 0, 1, 0, 1, 0, 0, 1, 1).finished();
    SkinningWeights<S> weights{(MatrixX<S>(4, 2) << 1, 0, S(0.75), S(0.25), S(0.5), S(0.5), 0, 1).finished()};
    std::vector<AffineTransform<S>> joints{2};

    Example() {
        joints[1].linear = rotation_matrix_from_rotation_vector(Vector3<S>(S(0.3), S(-0.4), S(0.5)));
        joints[1].translation << 1, 2, 3;
    }
};

/// Of many points at once against one.
template <class Policy>
constexpr typename Policy::Scalar rounding() {
    using S = typename Policy::Scalar;
    return PackedSkinningPolicy<Policy> ? S(16) * std::numeric_limits<S>::epsilon() : S(0);
}

}  // namespace

TEST_CASE_TEMPLATE("every point goes where the blend of its row takes it", Policy, LinearBlend<float>,
                   LinearBlend<double>, DualQuaternion<float>, DualQuaternion<double>) {
    using S = typename Policy::Scalar;
    const Example<S> example;
    const Policy policy;
    MatrixX<S> prepared, expected_prepared;
    Matrix3X<S> x;
    skin_points_into(policy, example.joints, example.weights, example.rest, prepared, x);
    policy.prepare_into(example.joints, expected_prepared);
    CHECK(prepared == expected_prepared);
    REQUIRE(x.cols() == 4);
    for (Index v = 0; v < 4; ++v) {
        const Vector3<S> one = policy.blend(expected_prepared, example.weights.row(v))(example.rest.col(v));
        CHECK((x.col(v) - one).norm() <= rounding<Policy>() * one.norm());
    }
    CHECK((x.col(0) - example.rest.col(0)).norm() == S(0));
    Matrix3X<S> by_threads;
    skin_points_into(policy, example.joints, example.weights, example.rest, prepared, by_threads, ThreadExecutor(3));
    CHECK(by_threads == x);
}

TEST_CASE_TEMPLATE("any number of points moves as one by one, with the same bits for any number of threads", Policy,
                   LinearBlend<float>, LinearBlend<double>, DualQuaternion<float>, DualQuaternion<double>) {
    using S = typename Policy::Scalar;
    constexpr Index num_joints = 7;
    RandomGenerator random(3);
    std::vector<AffineTransform<S>> joints;
    for (Index j = 0; j < num_joints; ++j) {  // up to any angle: quaternions of both signs
        joints.push_back({random_rotation<S>(random), random_normal<Vector3<S>>(random)});
    }
    const Policy policy;
    for (const Index count : {1, 7, 8, 9, 16, 31, 200}) {
        MatrixX<S> dense(count, num_joints);
        Matrix3X<S> rest(3, count);
        for (Index v = 0; v < count; ++v) {
            for (Index j = 0; j < num_joints; ++j) {
                dense(v, j) = (v + j) % 3 == 0 ? S(random.uniform(0.1, 1)) : S(0);
            }
            dense.row(v) /= dense.row(v).sum();
            rest.col(v) = random_normal<Vector3<S>>(random);
        }
        const SkinningWeights<S> weights(dense);
        MatrixX<S> prepared;
        Matrix3X<S> x, by_threads;
        skin_points_into(policy, joints, weights, rest, prepared, x);
        for (Index v = 0; v < count; ++v) {
            const Vector3<S> one = policy.blend(prepared, weights.row(v))(rest.col(v));
            CHECK((x.col(v) - one).norm() <= S(4) * rounding<Policy>());
        }
        for (const int threads : {2, 3}) {
            skin_points_into(policy, joints, weights, rest, prepared, by_threads, ThreadExecutor(threads));
            CHECK(by_threads == x);
        }
    }
}

TEST_CASE("weights of other points are refused") {
    Example<double> example;
    example.rest.conservativeResize(3, 3);
    MatrixX<double> prepared;
    Matrix3X<double> x;
    CHECK(softtissue_test::refusal([&] {
              skin_points_into(LinearBlend<double>(), example.joints, example.weights, example.rest, prepared, x);
          }) == "skinning: weights of 4 points, expected 3");
}

TEST_CASE("a joint transform that is not finite is refused") {
    Example<double> example;
    example.joints[1].translation(2) = std::numeric_limits<double>::infinity();
    MatrixX<double> prepared;
    Matrix3X<double> x;
    CHECK(softtissue_test::refusal([&] {
              skin_points_into(LinearBlend<double>(), example.joints, example.weights, example.rest, prepared, x);
          }) == "skinning: transform of joint 1 is not finite");
}
