// SPDX-License-Identifier: MIT
#include <softtissue/skinning/posed_body.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("sizes follow the body; the same sizes keep the storage", S, float, double) {
    PosedBody<S> posed;
    CHECK(posed.num_vertices() == 0);
    posed.resize(5, 3);
    CHECK(posed.num_vertices() == 5);
    CHECK(posed.transforms.size() == 5);
    CHECK(posed.offsets.cols() == 5);
    CHECK(posed.joint_transforms.size() == 3);
    CHECK(posed.pose_features.size() == 18);
    const S* const positions = posed.positions.data();
    const AffineTransform<S>* const transforms = posed.transforms.data();
    posed.positions.setOnes();
    posed.resize(5, 3);
    CHECK(posed.positions.data() == positions);
    CHECK(posed.transforms.data() == transforms);
    CHECK(posed.positions.sum() == S(15));
}
