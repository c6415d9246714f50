// SPDX-License-Identifier: MIT
#include <softtissue/testing/skinning_laws.hpp>

#include <softtissue/io/smpl_file.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include "../unit/skinning/arm_body.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <limits>
#include <vector>

using namespace softtissue;
using softtissue_test::arm_body;
using softtissue_test::random_pose;

TEST_CASE_TEMPLATE("linear blending obeys the skinning laws", S, float, double) {
    const LawReport report = check_skinning_laws(LinearBlend<S>{});
    CHECK_MESSAGE(report.all_passed(), report.summary());
}

TEST_CASE_TEMPLATE("dual quaternion blending obeys the skinning laws and is rigid", S, float, double) {
    const LawReport report = check_skinning_laws(DualQuaternion<S>{}, {.is_rigid = true});
    CHECK_MESSAGE(report.all_passed(), report.summary());
}

TEST_CASE_TEMPLATE("both policies agree where one joint has all the weight", S, float, double) {
    const std::vector<AffineTransform<S>> joints =
        joint_transforms<S>(KinematicTree({-1, 0, 1}), Matrix3X<S>::Ones(3, 3), random_pose<S>(3, 4, 3));
    MatrixX<S> linear, dual;
    LinearBlend<S>{}.prepare_into(joints, linear);
    DualQuaternion<S>{}.prepare_into(joints, dual);
    for (std::int32_t j = 0; j < 3; ++j) {
        const std::vector<JointWeight<S>> row{{j, S(1)}};
        const AffineTransform<S> a = LinearBlend<S>{}.blend(linear, row), b = DualQuaternion<S>{}.blend(dual, row);
        const S tolerance = 20 * std::numeric_limits<S>::epsilon();
        CHECK((a.linear - b.linear).norm() <= tolerance);
        CHECK((a.translation - b.translation).norm() <= 2 * tolerance);
    }
}

TEST_CASE_TEMPLATE("skinned bodies obey the body laws", S, float, double) {
    VolumetricSmpl linear(arm_body<S>());
    linear.set_shape(VectorX<S>::Constant(2, S(0.8)));
    const LawReport linear_report = check_skinned_body_laws(linear);
    CHECK_MESSAGE(linear_report.all_passed(), linear_report.summary());
    const VolumetricSmpl rigid(arm_body<S>(), DualQuaternion<S>{}, {.pose_correctives = false});
    const LawReport rigid_report = check_skinned_body_laws(rigid);
    CHECK_MESSAGE(rigid_report.all_passed(), rigid_report.summary());
}

TEST_CASE("a real body obeys the body laws") {
    const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data/body/body_small.npz";
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: " << path.string() << " is not here");
        return;
    }
    const LawReport report =
        check_skinned_body_laws(VolumetricSmpl(read_smpl_body<double>(path)), {.samples = 3});
    CHECK_MESSAGE(report.all_passed(), report.summary());
}
