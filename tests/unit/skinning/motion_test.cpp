// SPDX-License-Identifier: MIT
#include <softtissue/skinning/motion.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
Motion<S> three_frames() {
    return {{Pose<S>::rest(2), Pose<S>::rest(2), Pose<S>::rest(2)}, S(60)};
}

}  // namespace

TEST_CASE_TEMPLATE("three frames at 60 per second last a thirtieth of a second", S, float, double) {
    const Motion<S> motion = three_frames<S>();
    CHECK(motion.num_frames() == 3);
    CHECK(motion.duration() == S(2) / S(60));
    CHECK(Motion<S>{}.duration() == S(0));
    CHECK_NOTHROW(motion.validate("walk.npz", 2));
}

TEST_CASE_TEMPLATE("what cannot be played is refused, with frame and joint", S, float, double) {
    CHECK_THROWS_WITH_AS((Motion<S>{{}, S(60)}.validate("m", 2)), "m: the motion has no frames", InvalidInput);
    Motion<S> motion = three_frames<S>();
    motion.frame_rate = S(0);
    CHECK_THROWS_WITH_AS(motion.validate("m", 2), "m: frame rate is 0, expected > 0", InvalidInput);
    motion.frame_rate = std::numeric_limits<S>::infinity();
    CHECK_THROWS_WITH_AS(motion.validate("m", 2), "m: frame rate is inf, expected > 0", InvalidInput);

    motion = three_frames<S>();
    CHECK_THROWS_WITH_AS(motion.validate("m", 24),
                         "m: frame 0 has 2 joints, expected 24 (a motion for another skeleton)", InvalidInput);
    motion.poses[2].rotation_vectors(1, 1) = std::numeric_limits<S>::quiet_NaN();
    CHECK_THROWS_WITH_AS(motion.validate("m", 2), "m: frame 2, joint 1: rotation is not finite", InvalidInput);
    motion.poses[2].rotation_vectors(1, 1) = std::numeric_limits<S>::max();  // no angle: its square is infinite
    CHECK_THROWS_WITH_AS(motion.validate("m", 2), "m: frame 2, joint 1: rotation is not finite", InvalidInput);
    motion = three_frames<S>();
    motion.poses[1].translation(0) = std::numeric_limits<S>::infinity();
    CHECK_THROWS_WITH_AS(motion.validate("m", 2), "m: frame 1: translation is not finite", InvalidInput);
}
