// SPDX-License-Identifier: MIT
#include <softtissue/skinning/skin_points.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>

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
        CHECK(x.col(v) == policy.blend(expected_prepared, example.weights.row(v))(example.rest.col(v)));
    }
    CHECK(x.col(0) == example.rest.col(0));
    Matrix3X<S> by_threads;
    skin_points_into(policy, example.joints, example.weights, example.rest, prepared, by_threads, ThreadExecutor(3));
    CHECK(by_threads == x);
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
