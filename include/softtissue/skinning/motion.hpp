// SPDX-License-Identifier: MIT
/// @file
/// A motion: poses at a constant frame rate.
///
/// What        the poses of a clip as AMASS stores them.
/// Shapes      poses[t].rotation_vectors 3 x joints [rad], translation 3 [m]; frame_rate [1/s].
/// Refuses     validate(): no frames, a frame rate that is not positive, values that are not finite, another
///             number of joints than expected (InvalidInput names frame and joint).
/// Tests       tests/unit/skinning/motion_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/pose.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct Motion {
    using Scalar = S;

    std::vector<Pose<Scalar>> poses;
    Scalar frame_rate = Scalar(0);

    Index num_frames() const { return static_cast<Index>(poses.size()); }
    Scalar duration() const { return poses.empty() ? Scalar(0) : Scalar(num_frames() - 1) / frame_rate; }

    /// Throws InvalidInput unless this is a motion of a skeleton with `num_joints` joints; `source` starts the message.
    void validate(const std::string& source, Index num_joints) const {
        require(!poses.empty(), source, ": the motion has no frames");
        require(std::isfinite(frame_rate) && frame_rate > Scalar(0), source, ": frame rate is ", frame_rate,
                ", expected > 0");
        for (Index t = 0; t < num_frames(); ++t) {
            const Pose<Scalar>& pose = poses[size_t(t)];
            require(pose.rotation_vectors.cols() == num_joints, source, ": frame ", t, " has ",
                    pose.rotation_vectors.cols(), " joints, expected ", num_joints, " (a motion for another skeleton)");
            for (Index j = 0; j < num_joints; ++j) {
                // an angle whose square overflows has no sine either
                require(std::isfinite(pose.rotation_vectors.col(j).squaredNorm()), source, ": frame ", t, ", joint ", j,
                        ": rotation is not finite");
            }
            require(pose.translation.allFinite(), source, ": frame ", t, ": translation is not finite");
        }
    }
};

}  // namespace softtissue
