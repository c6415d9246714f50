// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/fat_thickness.hpp>

#include <softtissue/model/human_solid.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

template <class S>
constexpr double fat_rounding = double(64 * std::numeric_limits<S>::epsilon());

}  // namespace

TEST_CASE_TEMPLATE("corpulence: one at the reference depth, its square beyond, bounded", S, float, double) {
    const BodyAnatomy anatomy = smpl_anatomy();
    MatrixX<S> weights = MatrixX<S>::Zero(24, 48);
    VectorX<S> depth(48);
    const S scale = S(1.1);
    for (Index v = 0; v < 48; ++v) {
        weights(v % 24, v) = S(1);
        depth(v) = scale * S(anatomy.depth[size_t(v % 24)]) * (v < 24 ? S(0.9) : S(1.1));  // means are one
    }
    CHECK((corpulence(anatomy, scale, depth, weights).array() - S(1)).abs().maxCoeff() < fat_rounding<S>);
    CHECK((corpulence<S>(anatomy, scale, depth * S(1.2), weights).array() - S(1.44)).abs().maxCoeff() <
          fat_rounding<S>);
    CHECK(corpulence<S>(anatomy, scale, depth * S(9), weights) == VectorX<S>::Constant(24, S(3)));
    CHECK(corpulence<S>(anatomy, scale, depth * S(0.1), weights) == VectorX<S>::Constant(24, S(0.5)));
    weights.row(7).setZero();  // a joint that moves nothing here
    CHECK(corpulence<S>(anatomy, scale, depth * S(9), weights)(7) == S(1));
}

TEST_CASE_TEMPLATE("the table's thickness, blended by weights; more behind the pelvis; a lower bound", S, float,
                   double) {
    const BodyAnatomy anatomy = smpl_anatomy();
    const Matrix3X<S> joints = human_rest_joints().cast<S>();
    // 0, 1: behind and before the pelvis; 2: forearm; 3: half pelvis (before), half thigh; 4: toes.
    Matrix3X<S> skin(3, 5);
    skin << joints.col(0), joints.col(0), joints.col(18), joints.col(0), joints.col(10);
    skin.row(2) << S(-0.1), S(0.2), S(0), S(0.2), S(0);
    MatrixX<S> weights = MatrixX<S>::Zero(24, 5);
    weights(0, 0) = weights(0, 1) = weights(18, 2) = weights(10, 4) = S(1);
    weights(0, 3) = weights(1, 3) = S(0.5);
    const BoneTargets<S> bones(anatomy, joints, skin, weights);
    const S h = bones.scale();
    Matrix3X<S> targets = skin;
    for (Index v = 0; v < 5; ++v) {
        S depth(0);
        for (Index j = 0; j < 24; ++j) {
            depth += weights(j, v) > S(0) ? S(anatomy.depth[size_t(j)]) : S(0);
        }
        targets(1, v) += h * depth / S((weights.col(v).array() > S(0)).count());
    }
    targets(1, 3) = skin(1, 3) + h * S(anatomy.depth[0]);
    const VectorX<S> fat = fat_thickness<S>(anatomy, bones, skin, targets, weights, S(0.0031));
    const S thigh = S(std::pow(anatomy.depth[0] / anatomy.depth[1], 2));  // corpulence of joint 1
    CHECK(std::abs(fat(1) - h * S(0.020)) < S(fat_rounding<S>));
    CHECK(std::abs(fat(0) - h * S(0.032)) < h * S(0.001));  // the trunk leans a little
    CHECK(std::abs(fat(2) - h * S(0.004)) < S(fat_rounding<S>));
    CHECK(std::abs(fat(3) - h * (S(0.010) + thigh * S(0.0055))) < S(fat_rounding<S>));
    CHECK(fat(4) == S(0.0031));
}
