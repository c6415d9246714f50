// SPDX-License-Identifier: MIT
#include <softtissue/ndg/pose_features.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
Pose<S> random_pose(Index num_joints, std::uint64_t seed) {
    RandomGenerator random(seed);
    Pose<S> pose = Pose<S>::rest(num_joints);
    for (S& angle : pose.rotation_vectors.reshaped()) {
        angle = S(0.7 * random.normal());
    }
    return pose;
}

}  // namespace

TEST_CASE_TEMPLATE("all joints but the root, row after row", S, float, double) {
    const KinematicTree tree({1, KinematicTree::no_parent, 1, 0});  // the root is joint 1
    const Pose<S> pose = random_pose<S>(4, 3);
    VectorX<double> features(num_pose_features(tree));
    REQUIRE(features.size() == 27);
    pose_features_into<double>(tree, pose, features);
    const Index joints[] = {0, 2, 3};
    for (Index k = 0; k < 3; ++k) {
        const Matrix3<S> R = local_rotation(pose, joints[k]);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                CHECK(features(9 * k + 3 * row + column) == double(R(row, column)));
            }
        }
    }
    std::vector<Matrix3<S>> rotations;
    for (Index j = 0; j < 4; ++j) {
        rotations.push_back(local_rotation(pose, j));
    }
    VectorX<double> from_matrices(27);
    pose_features_into<double, S>(tree, rotations, from_matrices);
    CHECK(from_matrices == features);
}

TEST_CASE("the root and the translation do not matter") {
    const KinematicTree tree({KinematicTree::no_parent, 0, 1});
    Pose<double> pose = random_pose<double>(3, 4);
    VectorX<float> features(18), turned(18);
    pose_features_into<float>(tree, pose, features);
    pose.rotation_vectors.col(0) << 1, 2, 3;
    pose.translation << 1, 2, 3;
    pose_features_into<float>(tree, pose, turned);
    CHECK(features == turned);
    pose.rotation_vectors(2, 2) += 0.1;
    pose_features_into<float>(tree, pose, turned);
    CHECK(features != turned);
}

TEST_CASE("what is no pose of the skeleton is refused") {
    const KinematicTree tree({KinematicTree::no_parent, 0, 1});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    VectorX<float> features(18), small(9);
    const auto message = [&](const Pose<double>& pose, VectorX<float>& room) -> std::string {
        try {
            pose_features_into<float>(tree, pose, room);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    };
    Pose<double> pose = Pose<double>::rest(3);
    CHECK(message(pose, features).empty());
    CHECK(message(pose, small) == "pose features: room for 9 numbers, expected 18");
    CHECK(message(Pose<double>::rest(2), features) == "pose features: a pose of 2 joints, expected 3");
    pose.rotation_vectors(1, 0) = nan;  // also of the root
    CHECK(message(pose, features) == "pose features: the rotation vector of joint 0 is not finite");
    pose = Pose<double>::rest(3);
    pose.rotation_vectors(1, 2) = std::numeric_limits<double>::infinity();
    CHECK(message(pose, features) == "pose features: the rotation vector of joint 2 is not finite");
    pose.rotation_vectors(1, 2) = 1e200;  // its square is infinite: it has no angle
    CHECK(message(pose, features) == "pose features: the rotation vector of joint 2 is not finite");
    pose = Pose<double>::rest(3);
    pose.translation(1) = nan;
    CHECK(message(pose, features) == "pose features: the translation is not finite");
    std::vector<Matrix3<double>> rotations(3, Matrix3<double>::Identity());
    rotations[1](0, 2) = nan;
    CHECK_THROWS_WITH_AS((pose_features_into<float, double>(tree, rotations, features)),
                         "pose features: the rotation of joint 1 is not finite", InvalidInput);
    rotations.pop_back();
    CHECK_THROWS_WITH_AS((pose_features_into<float, double>(tree, rotations, features)),
                         "pose features: 2 joint rotations, expected 3", InvalidInput);
}
