// SPDX-License-Identifier: MIT
#include <softtissue/skinning/blended_rotation.hpp>

#include "blend_reference.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// Joints with random rotations of up to `largest_angle`.
template <class S>
std::vector<AffineTransform<S>> random_joints(size_t count, double largest_angle, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<AffineTransform<S>> joints(count);
    for (AffineTransform<S>& T : joints) {
        T.linear = rotation_matrix_from_rotation_vector<S>(random_unit<Vector3<S>>(random) *
                                                           S(random.uniform(0, largest_angle)));
    }
    return joints;
}

template <class S>
SkinningWeights<S> random_weights(Index rows, Index joints) {
    RandomGenerator random(8);
    MatrixX<S> dense(rows, joints);
    for (Index r = 0; r < rows; ++r) {
        for (Index j = 0; j < joints; ++j) {
            dense(r, j) = S(random.uniform(0.01, 1));
        }
        dense.row(r) /= dense.row(r).sum();
    }
    return SkinningWeights<S>(dense);
}

}  // namespace

TEST_CASE_TEMPLATE("two equal bones give half the rotation, whatever the signs", S, float, double) {
    const Quaternion<S> a(1, 0, 0, 0), b = quaternion_from_rotation_vector(Vector3<S>(0, 0, S(1.6)));
    const std::vector<JointWeight<S>> row{{0, S(0.5)}, {1, S(0.5)}};
    const Quaternion<S> expected = quaternion_from_rotation_vector(Vector3<S>(0, 0, S(0.8)));
    for (const S sign : {S(1), S(-1)}) {
        const std::vector<Quaternion<S>> bones{a, sign * b};
        CHECK((blended_quaternion<S>(bones, row) - expected).norm() <= 4 * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("rows are cut to the eight largest weights, largest first, equal ones by joint", S, float, double) {
    MatrixX<S> dense(1, 10);
    dense << 1, 2, 3, 4, 5, 6, 7, 8, 9, 9;
    dense /= dense.sum();
    const BlendedRotations<S> blended{SkinningWeights<S>(dense)};
    REQUIRE(blended.num_rows() == 1);
    const auto row = blended.row(0);
    REQUIRE(row.size() == max_blended_bones);
    CHECK(row[0].joint == 8);
    CHECK(row[1].joint == 9);
    CHECK(row[7].joint == 2);
    CHECK(row[0].weight == row[1].weight);
    // the two smallest bones have no say
    std::vector<AffineTransform<S>> joints(10);
    joints[0].linear = joints[1].linear = rotation_matrix_from_rotation_vector(Vector3<S>(1, 2, 0));
    CHECK(blended.rotations(joints)[0] == Matrix3<S>::Identity());
}

TEST_CASE_TEMPLATE("the blend is a rotation for any bones, and turns with the body", S, float, double) {
    const BlendedRotations<S> blended(random_weights<S>(100, 8));
    const S tolerance = 20 * std::numeric_limits<S>::epsilon();
    for (const Matrix3<S>& R : blended.rotations(random_joints<S>(8, 3.1, 1))) {
        CHECK(is_rotation(R, tolerance));
    }
    const std::vector<AffineTransform<S>> joints = random_joints<S>(8, 1.2, 2);
    std::vector<AffineTransform<S>> turned = joints;
    const Matrix3<S> G = rotation_matrix_from_rotation_vector(Vector3<S>(2, -1, 1));
    for (AffineTransform<S>& T : turned) {
        T.linear = G * T.linear;
    }
    const std::vector<Matrix3<S>> before = blended.rotations(joints), after = blended.rotations(turned);
    for (size_t r = 0; r < before.size(); ++r) {
        CHECK((after[r] - G * before[r]).norm() <= 2 * tolerance);
    }
}

TEST_CASE("same bits for any number of threads") {
    const BlendedRotations<double> blended(random_weights<double>(1001, 6));
    const std::vector<AffineTransform<double>> joints = random_joints<double>(6, 2, 3);
    const std::vector<Matrix3<double>> expected = blended.rotations(joints);
    for (const int threads : {1, 2, 7}) {
        std::vector<Matrix3<double>> parallel(1001);
        blended.rotations_into(bone_quaternions<double>(joints), parallel, ThreadExecutor(threads));
        CHECK(parallel == expected);
    }
}

TEST_CASE("another number of bones or rows is refused") {
    const BlendedRotations<double> blended(random_weights<double>(2, 3));
    CHECK_THROWS_WITH_AS(blended.rotations(random_joints<double>(4, 1, 1)), "blended rotations: 4 bones, expected 3",
                         InvalidInput);
    std::vector<Matrix3<double>> rotations(1);
    CHECK_THROWS_WITH_AS(blended.rotations_into(bone_quaternions<double>(random_joints<double>(3, 1, 1)), rotations),
                         "blended rotations: 1 rotations, expected 2", InvalidInput);
    std::vector<AffineTransform<double>> joints = random_joints<double>(3, 1, 1);
    joints[2].linear(0, 0) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(blended.rotations(joints), "blended rotations: quaternion of joint 2 is not finite",
                         InvalidInput);
}

TEST_CASE("agrees with independent software") {
    for (const std::string& name : softtissue_test::blend_reference_names) {
        if (!std::filesystem::exists(softtissue_test::blend_reference_path(name))) {
            MESSAGE("skipped: " << softtissue_test::blend_reference_path(name).string() << " is not here");
            continue;
        }
        const softtissue_test::BlendReference reference(name);
        const auto expected = reference.file.at("dqs_R").matrices<double, 3, 3>();
        const auto rotations = BlendedRotations<double>(reference.weights).rotations(reference.joints);
        double worst = 0;
        for (size_t v = 0; v < expected.size(); ++v) {
            worst = std::max(worst, (rotations[v] - expected[v]).norm());
        }
        MESSAGE(name << ": rotations within " << worst);
        CHECK(worst <= 1e-12);
    }
}
