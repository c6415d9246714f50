// SPDX-License-Identifier: MIT
/// @file
/// Few poses that cover many: distances between poses, farthest-point sampling, and variations of a pose.
///
/// What        pose_distance(), farthest_poses(), with_joints_of() (the legs of another frame), with_noise().
/// Equation    d(a, b) = sum_j angle(R_j(a)^T R_j(b)) over all joints, angles in [0, pi]
///             farthest_poses: the pose farthest from rest, then again and again the one whose nearest chosen pose is farthest
/// Units       rad
/// Valid       any rotation vectors. The same bits for every executor; of equals the first.
/// Refuses     poses of different skeletons, more poses than there are, a deviation that is negative (InvalidInput).
/// Source      Nolte et al. 2026, sec. 4.1; Gonzalez 1985
/// Cost        farthest_poses: at most poses x chosen x joints arcsines; a comparison ends as soon as its sum is too large
/// Tests       tests/unit/ndg/pose_sampling_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/pose.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace softtissue {

namespace detail {

/// Unit quaternions of all joints, 4 x joints.
template <RealScalar S>
using PoseQuaternions = Eigen::Matrix<S, 4, Eigen::Dynamic>;

template <RealScalar S>
PoseQuaternions<S> pose_quaternions(const Pose<S>& pose) {
    PoseQuaternions<S> result(4, pose.rotation_vectors.cols());
    for (Index j = 0; j < result.cols(); ++j) {
        result.col(j) = quaternion_from_rotation_vector<S>(pose.rotation_vectors.col(j));
    }
    return result;
}

/// The distance, or what has been summed when it exceeds `limit`.
template <RealScalar S>
S limited_distance(const PoseQuaternions<S>& a, const PoseQuaternions<S>& b, S limit) {
    S sum(0);
    for (Index j = 0; j < a.cols() && sum <= limit; ++j) {
        const S chord_squared = std::min((a.col(j) - b.col(j)).squaredNorm(), (a.col(j) + b.col(j)).squaredNorm());
        sum += S(4) * std::asin(std::min(std::sqrt(chord_squared) / S(2), S(1)));  // keeps its digits near 0
    }
    return sum;
}

}  // namespace detail

/// Sum over the joints of the angle between the two rotations.
template <RealScalar S>
S pose_distance(const Pose<S>& a, const Pose<S>& b) {
    require(a.rotation_vectors.cols() == b.rotation_vectors.cols(), "pose distance: ", a.rotation_vectors.cols(),
            " and ", b.rotation_vectors.cols(), " joints, expected the same skeleton");
    return detail::limited_distance<S>(detail::pose_quaternions(a), detail::pose_quaternions(b),
                                       std::numeric_limits<S>::infinity());
}

/// `count` of the poses, in the order in which they were chosen.
template <RealScalar S, Executor E = SequentialExecutor>
std::vector<Index> farthest_poses(std::span<const Pose<S>> poses, Index count, const E& executor = {}) {
    const Index num_poses = Index(poses.size());
    require(count >= 0 && count <= num_poses, "farthest poses: ", count, " of ", num_poses, " poses");
    std::vector<detail::PoseQuaternions<S>> rotations;
    for (const Pose<S>& pose : poses) {
        require(pose.rotation_vectors.cols() == poses.front().rotation_vectors.cols(), "farthest poses: pose ",
                rotations.size(), " has ", pose.rotation_vectors.cols(), " joints, expected ",
                poses.front().rotation_vectors.cols());
        rotations.push_back(detail::pose_quaternions(pose));
    }
    std::vector<Index> chosen;
    if (count == 0) {
        return chosen;
    }
    constexpr S infinity = std::numeric_limits<S>::infinity();
    const detail::PoseQuaternions<S> rest =
        detail::pose_quaternions(Pose<S>::rest(poses.front().rotation_vectors.cols()));
    std::vector<S> nearest(poses.size());
    for (size_t i = 0; i < poses.size(); ++i) {
        nearest[i] = detail::limited_distance(rotations[i], rest, infinity);
    }
    chosen.push_back(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    std::fill(nearest.begin(), nearest.end(), infinity);
    while (Index(chosen.size()) < count) {
        const Index last = chosen.back();
        executor.for_each_range(num_poses, [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                S& least = nearest[size_t(i)];
                least = i == last ? S(-1)  // never again, not even where all are equal
                                  : std::min(least, detail::limited_distance(rotations[size_t(i)],
                                                                             rotations[size_t(last)], least));
            }
        });
        chosen.push_back(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    return chosen;
}

/// `pose` with the rotations of `joints` taken from `other`.
template <RealScalar S>
Pose<S> with_joints_of(Pose<S> pose, const Pose<S>& other, std::span<const std::int32_t> joints) {
    require(pose.rotation_vectors.cols() == other.rotation_vectors.cols(),
            "mixed poses: ", pose.rotation_vectors.cols(), " and ", other.rotation_vectors.cols(),
            " joints, expected the same skeleton");
    for (const std::int32_t joint : joints) {
        require(joint >= 0 && joint < pose.rotation_vectors.cols(), "mixed poses: joint ", joint, ", expected 0 to ",
                pose.rotation_vectors.cols() - 1);
        pose.rotation_vectors.col(joint) = other.rotation_vectors.col(joint);
    }
    return pose;
}

/// `pose` with normal numbers of this deviation [rad] added to the rotation vectors of all joints but the root (joint 0).
template <RealScalar S>
Pose<S> with_noise(Pose<S> pose, double deviation, RandomGenerator& random) {
    require(deviation >= 0.0, "noise of poses: deviation ", deviation, ", expected >= 0");
    for (Index j = 1; j < pose.rotation_vectors.cols(); ++j) {
        for (Index d = 0; d < 3; ++d) {
            pose.rotation_vectors(d, j) += S(deviation * random.normal());
        }
    }
    return pose;
}

}  // namespace softtissue
