// SPDX-License-Identifier: MIT
// Poses within the limits of joints, and far beyond.
#pragma once

#include <softtissue/core/random.hpp>
#include <softtissue/skinning/pose.hpp>

#include <cmath>
#include <numbers>

namespace reliability {

using namespace softtissue;

/// One joint, some or all turn; by angles that a joint reaches, up to half a turn, by exactly half a turn, several times
/// round, or by a million turns. About any axis or one of the three.
template <class S>
Pose<S> random_pose(Index num_joints, RandomGenerator& random) {
    const double pi = std::numbers::pi;
    Pose<S> pose = Pose<S>::rest(num_joints);
    const double share = random.uniform() < 0.3 ? 1.0 : random.uniform();
    const Index only = random.uniform() < 0.2 ? random.index(num_joints) : -1;
    const Index how_far = random.index(12);
    for (Index j = 0; j < num_joints; ++j) {
        if (only >= 0 ? j != only : random.uniform() > share) {
            continue;
        }
        Vector3<double> axis(random.normal(), random.normal(), random.normal());
        axis.normalize();
        if (random.uniform() < 0.4) {
            axis = (random.uniform() < 0.5 ? 1.0 : -1.0) * Vector3<double>::Unit(random.index(3));
        }
        double angle = random.uniform(0, 2.5);
        if (how_far >= 11) {
            angle = random.uniform(0, 2e6 * pi);
        } else if (how_far >= 9) {
            angle = random.uniform(0, 6 * pi);
        } else if (how_far >= 7) {
            angle = pi;
        } else if (how_far >= 4) {
            angle = random.uniform(0, pi);
        }
        const Vector3<double> r = angle * axis;
        pose.rotation_vectors.col(j) = r.cast<S>();
    }
    pose.translation << S(random.normal()), S(random.normal()), S(random.normal());
    return pose;
}

/// A part of the way from one pose to another, joint by joint.
template <class S>
Pose<S> between(const Pose<S>& from, const Pose<S>& to, double part) {
    Pose<S> pose = from;
    pose.rotation_vectors = S(1 - part) * from.rotation_vectors + S(part) * to.rotation_vectors;
    pose.translation = S(1 - part) * from.translation + S(part) * to.translation;
    return pose;
}

}  // namespace reliability
