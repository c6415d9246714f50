// SPDX-License-Identifier: MIT
#include <softtissue/ndg/pose_sampling.hpp>

#include <softtissue/core/thread_executor.hpp>

#include <doctest/doctest.h>

#include <array>
#include <numbers>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
std::vector<Pose<S>> random_poses(Index count, Index joints) {
    RandomGenerator random(7);
    std::vector<Pose<S>> poses(size_t(count), Pose<S>::rest(joints));
    for (Pose<S>& pose : poses) {
        pose = with_noise(pose, 0.7, random);
    }
    return poses;
}

}  // namespace

TEST_CASE_TEMPLATE("distance is the sum of the angles between the joints", S, float, double) {
    Pose<S> a = Pose<S>::rest(3), b = a;
    CHECK(pose_distance(a, b) == S(0));
    a.rotation_vectors.col(1) << S(0.3), S(0), S(0);
    b.rotation_vectors.col(1) << S(-0.5), S(0), S(0);
    b.rotation_vectors.col(2) << S(0), S(1e-3), S(0);
    const double tolerance = 40 * double(std::numeric_limits<S>::epsilon());
    CHECK(double(pose_distance(a, b)) == doctest::Approx(0.801).epsilon(tolerance));
    CHECK(pose_distance(a, b) == pose_distance(b, a));

    // A rotation and the same one turned by once more around are one; half a turn is the farthest.
    Pose<S> c = a;
    c.rotation_vectors.col(1) *= S((0.3 - 2 * std::numbers::pi) / 0.3);
    CHECK(double(pose_distance(a, c)) < 1e3 * double(std::numeric_limits<S>::epsilon()));
    c.rotation_vectors.col(1) << S(0.3 + std::numbers::pi), S(0), S(0);
    CHECK(double(pose_distance(a, c)) == doctest::Approx(std::numbers::pi).epsilon(1e-3));
    CHECK_THROWS_AS(static_cast<void>(pose_distance(a, Pose<S>::rest(2))), InvalidInput);
}

TEST_CASE_TEMPLATE("each next pose is the farthest from all before", S, float, double) {
    const std::vector<Pose<S>> poses = random_poses<S>(60, 4);
    const std::vector<Index> chosen = farthest_poses<S>(poses, 20);
    REQUIRE(chosen.size() == 20);
    for (const Pose<S>& pose : poses) {
        CHECK(pose_distance(pose, Pose<S>::rest(4)) <= pose_distance(poses[size_t(chosen[0])], Pose<S>::rest(4)));
    }
    for (size_t k = 1; k < chosen.size(); ++k) {
        const auto nearest = [&](const Pose<S>& pose) {
            S least = std::numeric_limits<S>::infinity();
            for (size_t i = 0; i < k; ++i) {
                least = std::min(least, pose_distance(pose, poses[size_t(chosen[i])]));
            }
            return least;
        };
        const S reached = nearest(poses[size_t(chosen[k])]);
        CHECK(reached > S(0));
        for (const Pose<S>& pose : poses) {
            CHECK(nearest(pose) <= reached);
        }
    }
    CHECK(farthest_poses<S>(poses, 20, ThreadExecutor(3)) == chosen);
}

TEST_CASE("all poses can be chosen, equal ones too, but no more") {
    std::vector<Pose<double>> poses = random_poses<double>(3, 2);
    poses.push_back(poses[0]);
    poses.push_back(poses[0]);
    std::vector<Index> chosen = farthest_poses<double>(poses, 5);
    std::sort(chosen.begin(), chosen.end());
    CHECK(chosen == std::vector<Index>{0, 1, 2, 3, 4});
    CHECK(farthest_poses<double>(poses, 0).empty());
    CHECK_THROWS_AS(static_cast<void>(farthest_poses<double>(poses, 6)), InvalidInput);
    poses.push_back(Pose<double>::rest(3));
    CHECK_THROWS_AS(static_cast<void>(farthest_poses<double>(poses, 2)), InvalidInput);
}

TEST_CASE("legs of another pose, and noise that leaves the root alone") {
    const std::vector<Pose<double>> poses = random_poses<double>(2, 4);
    const std::array<std::int32_t, 2> legs{1, 3};
    const Pose<double> mixed = with_joints_of<double>(poses[0], poses[1], legs);
    for (Index j = 0; j < 4; ++j) {
        CHECK(mixed.rotation_vectors.col(j) == poses[j % 2 == 1 ? 1 : 0].rotation_vectors.col(j));
    }
    const std::array<std::int32_t, 1> outside{4};
    CHECK_THROWS_AS(static_cast<void>(with_joints_of<double>(poses[0], poses[1], outside)), InvalidInput);

    RandomGenerator random(3);
    double sum = 0;
    const int rounds = 200;
    for (int k = 0; k < rounds; ++k) {
        const Matrix3X<double> change = with_noise(poses[0], 0.1, random).rotation_vectors - poses[0].rotation_vectors;
        CHECK(change.col(0).isZero(0));
        sum += change.squaredNorm();
    }
    CHECK(std::sqrt(sum / (9 * rounds)) == doctest::Approx(0.1).epsilon(0.05));
    CHECK(with_noise(poses[0], 0.0, random).rotation_vectors == poses[0].rotation_vectors);
    CHECK_THROWS_AS(static_cast<void>(with_noise(poses[0], -0.1, random)), InvalidInput);
}
