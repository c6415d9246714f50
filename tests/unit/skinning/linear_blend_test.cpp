// SPDX-License-Identifier: MIT
#include <softtissue/skinning/linear_blend.hpp>

#include "blend_reference.hpp"

#include <softtissue/core/dual.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

static_assert(SkinningPolicy<LinearBlend<float>> && SkinningPolicy<LinearBlend<double>>);
static_assert(SkinningPolicy<LinearBlend<Dual<double, 3>>>);
static_assert(!SkinningPolicy<AffineTransform<double>>);

TEST_CASE_TEMPLATE("the weighted mean of the joint transforms", S, float, double) {
    std::vector<AffineTransform<S>> joints(3);
    joints[0].translation << 4, 0, 0;
    joints[2].linear *= S(3);
    joints[2].translation << 0, 8, 0;
    const LinearBlend<S> policy;
    MatrixX<S> prepared;
    policy.prepare_into(joints, prepared);
    const std::vector<JointWeight<S>> row{{0, S(0.25)}, {2, S(0.75)}};
    const AffineTransform<S> T = policy.blend(prepared, row);
    CHECK(T.linear == S(2.5) * Matrix3<S>::Identity());
    CHECK(T.translation == Vector3<S>(1, 6, 0));
}

TEST_CASE_TEMPLATE("a twist of a between two joints of equal weight shrinks by cos(a/2)", S, float, double) {
    for (const S a : {S(0.5), S(1), S(2), S(3)}) {
        std::vector<AffineTransform<S>> joints(2);
        joints[1].linear = rotation_matrix_from_rotation_vector(Vector3<S>(a, 0, 0));
        const LinearBlend<S> policy;
        MatrixX<S> prepared;
        policy.prepare_into(joints, prepared);
        const std::vector<JointWeight<S>> row{{0, S(0.5)}, {1, S(0.5)}};
        const Vector3<S> x = policy.blend(prepared, row)(Vector3<S>(0, 1, 0));
        CHECK(std::abs(x.norm() - std::cos(a / 2)) <= 4 * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("agrees with independent software to 1e-10 m") {
    for (const std::string& name : softtissue_test::blend_reference_names) {
        if (!std::filesystem::exists(softtissue_test::blend_reference_path(name))) {
            MESSAGE("skipped: " << softtissue_test::blend_reference_path(name).string() << " is not here");
            continue;
        }
        CAPTURE(name);
        const softtissue_test::BlendReference reference(name);
        const double error = reference.largest_error(LinearBlend<double>{}, "lbs");
        MESSAGE(name << ": largest error " << error << " m");
        CHECK(error <= 1e-10);
    }
}
