// SPDX-License-Identifier: MIT
#include <softtissue/skinning/pose.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("the rest pose turns nothing and moves nothing", S, float, double) {
    const Pose<S> pose = Pose<S>::rest(24);
    CHECK(pose.rotation_vectors.cols() == 24);
    CHECK(pose.rotation_vectors.isZero(S(0)));
    CHECK(pose.translation.isZero(S(0)));
}

TEST_CASE_TEMPLATE("a pose that is not finite is refused, also a rotation without a finite angle", S, float, double) {
    using Limits = std::numeric_limits<S>;
    CHECK_NOTHROW(Pose<S>::rest(3).require_finite("p"));
    for (const S bad : {Limits::quiet_NaN(), Limits::infinity(), Limits::max()}) {
        Pose<S> pose = Pose<S>::rest(3);
        pose.rotation_vectors(2, 1) = bad;
        CHECK_THROWS_WITH_AS(pose.require_finite("p"), "p: joint 1: rotation is not finite", InvalidInput);
    }
    Pose<S> pose = Pose<S>::rest(3);
    pose.translation.setConstant(Limits::max());
    CHECK_NOTHROW(pose.require_finite("p"));
    pose.translation(1) = -Limits::infinity();
    CHECK_THROWS_WITH_AS(pose.require_finite("p"), "p: translation is not finite", InvalidInput);
}
