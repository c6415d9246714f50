// SPDX-License-Identifier: MIT
/// @file
/// A small body in SMPL's form for tests: a tube around four joints with two shapes and random pose blend shapes.
#pragma once

#include <softtissue/skinning/pose.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/testing/random_states.hpp>

#include <array>
#include <cmath>

namespace softtissue_test {

using namespace softtissue;

/// Rings of six vertices along x from 0 to 1, joints at 0, 0.3, 0.6 and 0.9 (numbered 0, 1, 3, 2 along the tube).
template <class S>
SmplBody<S> arm_body(Index num_rings = 8) {
    RandomGenerator random(21);
    constexpr Index sides = 6;
    const Index n = num_rings * sides;
    SmplBody<S> body;
    body.tree = KinematicTree({KinematicTree::no_parent, 0, 3, 1});
    const std::array<double, 4> places{0, 0.3, 0.9, 0.6};
    body.template_vertices.resize(3, n);
    MatrixX<S> weights(n, 4);
    for (Index v = 0; v < n; ++v) {
        const double x = double(v / sides) / double(num_rings - 1), angle = double(v % sides);
        body.template_vertices.col(v) << S(x), S(0.1 * std::cos(angle)), S(0.1 * std::sin(angle));
        for (Index j = 0; j < 4; ++j) {
            const double distance = std::abs(x - places[size_t(j)]);
            weights(v, j) = S(distance < 0.4 ? 0.4 - distance : 0);
        }
        weights.row(v) /= weights.row(v).sum();
    }
    body.weights = SkinningWeights<S>(weights);
    MatrixX<S> regressor = MatrixX<S>::Zero(4, n);
    for (Index j = 0; j < 4; ++j) {  // the ring closest to the joint
        const Index ring = Index(std::lround(places[size_t(j)] * double(num_rings - 1)));
        regressor.block(j, ring * sides, 1, sides).setConstant(S(1) / S(sides));
    }
    body.joint_regressor = regressor.sparseView();
    body.shape_directions.resize(3 * n, 2);
    MatrixX<S> pose_directions = MatrixX<S>::Zero(3 * n, 27);
    for (Index r = 0; r < 3 * n; ++r) {
        body.shape_directions.row(r) << body.template_vertices(r % 3, r / 3) * S(0.1), S(0.01 * random.normal());
        for (Index c = 0; c < 27; ++c) {
            if (random.uniform() < 0.2) {
                pose_directions(r, c) = S(0.01 * random.normal());
            }
        }
    }
    body.pose_directions = pose_directions.sparseView();
    return body;
}

/// A pose with every joint turned by up to `largest_angle`, and moved.
template <class S>
Pose<S> random_pose(Index num_joints, std::uint64_t seed, double largest_angle = 1) {
    RandomGenerator random(seed);
    Pose<S> pose = Pose<S>::rest(num_joints);
    for (Index j = 0; j < num_joints; ++j) {
        pose.rotation_vectors.col(j) = random_unit<Vector3<S>>(random) * S(random.uniform(0, largest_angle));
    }
    pose.translation = random_unit<Vector3<S>>(random);
    return pose;
}

}  // namespace softtissue_test
