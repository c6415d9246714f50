// SPDX-License-Identifier: MIT
#include <softtissue/skinning/joint_transforms.hpp>

#include <softtissue/core/dual.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

/// A tree whose numbers do not ascend from the root, with random joints and pose.
template <class S>
struct RandomSkeleton {
    KinematicTree tree{{3, 0, 0, -1, 1, 3, 4}};
    Matrix3X<S> joints;
    Pose<S> pose;

    explicit RandomSkeleton(std::uint64_t seed) {
        RandomGenerator random(seed);
        joints.resize(3, tree.num_joints());
        pose = Pose<S>::rest(tree.num_joints());
        for (Index j = 0; j < tree.num_joints(); ++j) {
            joints.col(j) = random_unit<Vector3<S>>(random);
            pose.rotation_vectors.col(j) = random_unit<Vector3<S>>(random) * S(random.uniform(0, 7));
        }
        pose.translation = random_unit<Vector3<S>>(random);
    }
};

/// The textbook form: products of 4x4 frames from the root to the joint, times the inverse rest frame.
template <class S>
Eigen::Matrix<S, 4, 4> textbook_transform(const RandomSkeleton<S>& s, Index joint) {
    using Frame = Eigen::Matrix<S, 4, 4>;
    Frame world = Frame::Identity();
    for (Index j = joint; j != KinematicTree::no_parent; j = s.tree.parent(j)) {
        Frame local = Frame::Identity();
        local.template topLeftCorner<3, 3>() = rotation_matrix_from_rotation_vector<S>(s.pose.rotation_vectors.col(j));
        const bool is_root = s.tree.parent(j) == KinematicTree::no_parent;
        local.template topRightCorner<3, 1>() =
            s.joints.col(j) - (is_root ? Vector3<S>::Zero().eval() : s.joints.col(s.tree.parent(j)).eval());
        world = local * world;
    }
    Frame to_rest = Frame::Identity();
    to_rest.template topRightCorner<3, 1>() = -s.joints.col(joint);
    Frame result = world * to_rest;
    result.template topRightCorner<3, 1>() += s.pose.translation;
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("the rest pose moves no joint", S, float, double) {
    const RandomSkeleton<S> s(1);
    for (const AffineTransform<S>& T : joint_transforms(s.tree, s.joints, Pose<S>::rest(7))) {
        CHECK(T.linear == Matrix3<S>::Identity());
        CHECK(T.translation.isZero(S(0)));
    }
}

TEST_CASE_TEMPLATE("an elbow bent by a right angle", S, float, double) {
    const KinematicTree tree({-1, 0, 1});
    Matrix3X<S> joints(3, 3);
    joints << 0, 1, 2, 0, 0, 0, 0, 0, 0;
    Pose<S> pose = Pose<S>::rest(3);
    pose.rotation_vectors(2, 1) = std::numbers::pi_v<S> / 2;
    pose.translation << 0, 0, 5;
    const auto transforms = joint_transforms(tree, joints, pose);
    const Matrix3X<S> posed = posed_joints(transforms, joints);
    const S tolerance = 4 * std::numeric_limits<S>::epsilon();
    CHECK(posed.col(0) == Vector3<S>(0, 0, 5));
    CHECK(posed.col(1) == Vector3<S>(1, 0, 5));
    CHECK((posed.col(2) - Vector3<S>(1, 1, 5)).norm() <= tolerance);
    CHECK((transforms[2](Vector3<S>(3, 0, 0)) - Vector3<S>(1, 2, 5)).norm() <= 2 * tolerance);
}

TEST_CASE_TEMPLATE("agrees with products of frames, whatever the numbering", S, float, double) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const RandomSkeleton<S> s(seed);
        const auto transforms = joint_transforms(s.tree, s.joints, s.pose);
        for (Index j = 0; j < 7; ++j) {
            const Eigen::Matrix<S, 4, 4> expected = textbook_transform(s, j);
            // five frames of lengths up to 2: some 50 roundings
            const S tolerance = 100 * std::numeric_limits<S>::epsilon();
            CHECK((transforms[size_t(j)].linear - expected.template topLeftCorner<3, 3>()).norm() <= tolerance);
            CHECK((transforms[size_t(j)].translation - expected.template topRightCorner<3, 1>()).norm() <= tolerance);
        }
    }
}

TEST_CASE("derivative of a posed joint by the root's rotation, at rest: omega x (c - c_root)") {
    using D = Dual<double, 3>;
    const RandomSkeleton<double> s(4);
    Pose<D> pose = Pose<D>::rest(7);
    for (int d = 0; d < 3; ++d) {
        pose.rotation_vectors(d, s.tree.root()) = D::variable(0.0, d);
    }
    const Matrix3X<D> joints = s.joints.cast<D>();
    const Matrix3X<D> posed = posed_joints(joint_transforms(s.tree, joints, pose), joints);
    const Eigen::Vector3d arm = s.joints.col(6) - s.joints.col(3);
    for (int d = 0; d < 3; ++d) {
        const Eigen::Vector3d expected = Eigen::Vector3d::Unit(d).cross(arm);
        for (int i = 0; i < 3; ++i) {
            CHECK(posed(i, 6).derivative[size_t(d)] == doctest::Approx(expected(i)).epsilon(1e-14));
        }
    }
}

TEST_CASE("joints or poses of another skeleton are refused") {
    const KinematicTree tree({-1, 0});
    const Matrix3X<double> joints = Matrix3X<double>::Zero(3, 2);
    CHECK_THROWS_WITH_AS(joint_transforms(tree, joints, Pose<double>::rest(3)),
                         "joint_transforms: the pose has 3 joints, expected 2", InvalidInput);
    CHECK_THROWS_WITH_AS(joint_transforms<double>(tree, Matrix3X<double>::Zero(3, 1), Pose<double>::rest(2)),
                         "joint_transforms: 1 rest joints, expected 2", InvalidInput);
    CHECK_THROWS_WITH_AS(posed_joints<double>(std::vector<AffineTransform<double>>(3), joints),
                         "posed_joints: 3 transforms, expected 2", InvalidInput);
}

TEST_CASE("a pose that is not finite is refused, with the joint") {
    const KinematicTree tree({-1, 0});
    const Matrix3X<double> joints = Matrix3X<double>::Zero(3, 2);
    Pose<double> pose = Pose<double>::rest(2);
    pose.rotation_vectors(0, 1) = 1e200;  // finite, but it has no sine
    CHECK_THROWS_WITH_AS(joint_transforms(tree, joints, pose), "joint_transforms: joint 1: rotation is not finite",
                         InvalidInput);
}
