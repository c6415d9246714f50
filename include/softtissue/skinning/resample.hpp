// SPDX-License-Identifier: MIT
/// @file
/// A motion at another frame rate, smooth enough for dynamics.
///
/// What        frames at k / new_rate over the duration of the motion.
/// Equation    per joint the C2 spline of its sign-unrolled quaternions, normalised; the C2 spline of the translation
/// Valid       frames of the given motion come back (to rounding) where times meet. Between frames a joint turns the
///             shorter way. Twice continuously differentiable in time.
///             Rotation vectors are principal (|r| <= pi): the rotation is continuous, the vector jumps at pi.
///             However wildly a joint turns, the spline's quaternion is longer than 0.3 before it is normalised:
///             neighbouring frames lie within a quarter turn of the 4-sphere, and the far weights are small.
/// Refuses     what Motion::validate refuses, a rate that is not positive or gives more frames than 32-bit indices can number
///             (InvalidInput).
/// Source      Romero et al. 2020, sec. 4.1 needs accelerations of the pose, hence C2; de Boor 2001, ch. IV
/// Tests       tests/unit/skinning/resample_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/uniform_cubic_spline.hpp>

#include <cmath>
#include <limits>
#include <type_traits>

namespace softtissue {

namespace detail {

/// Quaternions of all joints, each on the side of its predecessor, over the translation: (4 joints + 3) x frames.
template <RealScalar S>
MatrixX<S> unrolled_curves(const Motion<S>& motion, Index num_joints) {
    MatrixX<S> curves(4 * num_joints + 3, motion.num_frames());
    for (Index t = 0; t < motion.num_frames(); ++t) {
        const Pose<S>& pose = motion.poses[size_t(t)];
        for (Index j = 0; j < num_joints; ++j) {
            Quaternion<S> q = quaternion_from_rotation_vector<S>(pose.rotation_vectors.col(j));
            if (t > 0) {
                q = aligned_quaternion<S>(q, curves.template block<4, 1>(4 * j, t - 1));
            }
            curves.template block<4, 1>(4 * j, t) = q;
        }
        curves.col(t).template tail<3>() = pose.translation;
    }
    return curves;
}

}  // namespace detail

/// The motion at `new_rate` frames per second.
template <RealScalar S>
Motion<S> resample(const Motion<S>& motion, std::type_identity_t<S> new_rate) {
    require(!motion.poses.empty(), "resample: the motion has no frames");
    const Index num_joints = motion.poses.front().rotation_vectors.cols();
    motion.validate("resample", num_joints);
    require(std::isfinite(new_rate) && new_rate > S(0), "resample: new frame rate is ", new_rate, ", expected > 0");

    const UniformCubicSpline<S> spline(detail::unrolled_curves(motion, num_joints));
    // The last frame belongs to the result where its time is met within rounding.
    const S exact_count = S(motion.num_frames() - 1) * (new_rate / motion.frame_rate);
    require(double(exact_count) < double(largest_index), "resample: frame rate from ", motion.frame_rate, " to ",
            new_rate, " gives ", exact_count, " frames, expected at most ", largest_index);
    const S rounding = S(4) * std::numeric_limits<S>::epsilon() * exact_count;
    const Index num_frames = Index(std::floor(exact_count + rounding)) + 1;

    Motion<S> result;
    result.frame_rate = new_rate;
    for (Index k = 0; k < num_frames; ++k) {
        const VectorX<S> values = spline(k == 0 ? S(0) : S(k) * (motion.frame_rate / new_rate));
        require(values.allFinite(), "resample: translations at new frame ", k,
                " are too large for the range of the numbers");
        Pose<S> pose = Pose<S>::rest(num_joints);
        for (Index j = 0; j < num_joints; ++j) {
            pose.rotation_vectors.col(j) = rotation_vector_from_quaternion<S>(values.template segment<4>(4 * j));
        }
        pose.translation = values.template tail<3>();
        result.poses.push_back(pose);
    }
    return result;
}

}  // namespace softtissue
