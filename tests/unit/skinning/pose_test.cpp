// SPDX-License-Identifier: MIT
#include <softtissue/skinning/pose.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("the rest pose turns nothing and moves nothing", S, float, double) {
    const Pose<S> pose = Pose<S>::rest(24);
    CHECK(pose.rotation_vectors.cols() == 24);
    CHECK(pose.rotation_vectors.isZero(S(0)));
    CHECK(pose.translation.isZero(S(0)));
}
