// SPDX-License-Identifier: MIT
/// @file
/// Motions of the procedural human, made by formula: a walk, a jump, a twist.
///
/// What        procedural_walk, procedural_jump, procedural_twist, and procedural_motion: the three in a row.
/// Equation    twice continuously differentiable intentions (steps of fifth degree) turned into poses by HumanPoser;
///             in the air the pelvis follows a parabola under gravity.
/// Shapes      24 joints; each clip begins and ends in the rest pose. Walk 2.9 s, jump 2.5 s, twist 2.3 s, all 6.5 s.
/// Units       frame_rate [1/s]
/// Valid       for procedural_human(): feet meet the floor of its rest shape.
/// Refuses     a frame rate that is not positive (InvalidInput).
/// Tests       tests/unit/model/procedural_motion_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/model/human_clips.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_poser.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/pose.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

namespace softtissue {
namespace detail {

/// Plays clips in a row, each from where the one before ended, between short passages from and to the rest pose.
template <RealScalar S>
Motion<S> play(std::initializer_list<HumanClip> clips, double frame_rate) {
    require(std::isfinite(frame_rate) && frame_rate > 0.0, "procedural motion: frame rate is ", frame_rate,
            ", expected > 0");
    constexpr double passage = 0.30;  // seconds
    const HumanPoser poser(human_rest_joints());
    double duration = 2.0 * passage;
    for (const HumanClip& clip : clips) {
        duration += clip.duration;
    }
    Motion<S> motion;
    motion.frame_rate = S(frame_rate);
    const int frames = int(std::floor(duration * frame_rate)) + 1;
    for (int frame = 0; frame < frames; ++frame) {
        const double time = double(frame) / frame_rate;
        double start = passage;
        double travelled = 0.0;
        const HumanClip* clip = clips.begin();
        while (clip + 1 != clips.end() && time > start + clip->duration) {
            start += clip->duration;
            travelled += clip->at(clip->duration).root(2);
            ++clip;
        }
        Pose<double> pose = poser(clip->at(std::clamp(time - start, 0.0, clip->duration)));
        const double risen = smooth_step(0.0, passage, time) * smooth_step(duration, duration - passage, time);
        pose.rotation_vectors *= risen;
        pose.translation(1) *= risen;
        pose.translation(2) += travelled;
        motion.poses.push_back({pose.rotation_vectors.cast<S>(), pose.translation.cast<S>()});
    }
    return motion;
}

}  // namespace detail

/// Four steps forwards.
template <RealScalar S>
Motion<S> procedural_walk(double frame_rate = 120.0) {
    return detail::play<S>({human_walk()}, frame_rate);
}

/// Crouch, jump of 0.2 m, landing.
template <RealScalar S>
Motion<S> procedural_jump(double frame_rate = 120.0) {
    return detail::play<S>({human_jump()}, frame_rate);
}

/// Fast turns of the trunk to both sides with the feet on the floor.
template <RealScalar S>
Motion<S> procedural_twist(double frame_rate = 120.0) {
    return detail::play<S>({human_twist()}, frame_rate);
}

/// Walk, jump and twist in a row.
template <RealScalar S>
Motion<S> procedural_motion(double frame_rate = 120.0) {
    return detail::play<S>({human_walk(), human_jump(), human_twist()}, frame_rate);
}

}  // namespace softtissue
