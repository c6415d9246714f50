// SPDX-License-Identifier: MIT
#include <softtissue/skinning/dual_quaternion.hpp>

#include "blend_reference.hpp"

#include <softtissue/core/dual.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <numbers>

using namespace softtissue;

static_assert(SkinningPolicy<DualQuaternion<float>> && SkinningPolicy<DualQuaternion<double>>);
static_assert(SkinningPolicy<DualQuaternion<Dual<double, 3>>>);
static_assert(!SkinningPolicy<Quaternion<double>>);

namespace {

template <class S>
AffineTransform<S> blend(const std::vector<AffineTransform<S>>& joints, const std::vector<JointWeight<S>>& row) {
    const DualQuaternion<S> policy;
    MatrixX<S> prepared;
    policy.prepare_into(joints, prepared);
    return policy.blend(prepared, row);
}

/// Angle in (-pi, pi] about x of the blend of a joint at rest (weight 0.6) and one twisted by `angle` (0.4).
double blended_twist(double angle) {
    std::vector<AffineTransform<double>> joints(2);
    joints[1].linear = rotation_matrix_from_rotation_vector(Eigen::Vector3d(angle, 0, 0));
    return rotation_vector_from_rotation_matrix(blend<double>(joints, {{0, 0.6}, {1, 0.4}}).linear)(0);
}

}  // namespace

TEST_CASE_TEMPLATE("half of a screw motion is a screw of half the angle and half the pitch", S, float, double) {
    const Vector3<S> axis = Vector3<S>(1, 2, 2) / S(3), centre(S(0.3), S(-0.2), S(0.5));
    const auto screw = [&](S angle, S pitch) -> AffineTransform<S> {
        const Matrix3<S> R = rotation_matrix_from_rotation_vector<S>(angle * axis);
        return {R, centre - R * centre + pitch * axis};
    };
    const S tolerance = 16 * std::numeric_limits<S>::epsilon();
    for (const S angle : {S(1e-4), S(0.7), S(2), S(3)}) {
        const AffineTransform<S> half =
            blend<S>({AffineTransform<S>{}, screw(angle, S(0.4))}, {{0, S(0.5)}, {1, S(0.5)}});
        const AffineTransform<S> expected = screw(angle / 2, S(0.2));
        CHECK((half.linear - expected.linear).norm() <= tolerance);
        // the pitch comes as a quotient by cos(angle/4) >= 0.7
        CHECK((half.translation - expected.translation).norm() <= 2 * tolerance);
    }
}

TEST_CASE_TEMPLATE("the sign of a joint's quaternion does not matter", S, float, double) {
    RandomGenerator random(2);
    const DualQuaternion<S> policy;
    for (int sample = 0; sample < 50; ++sample) {
        std::vector<AffineTransform<S>> joints;
        for (int j = 0; j < 3; ++j) {
            joints.push_back({random_rotation<S>(random), random_unit<Vector3<S>>(random)});
        }
        const std::vector<JointWeight<S>> row{{0, S(0.2)}, {1, S(0.5)}, {2, S(0.3)}};
        MatrixX<S> prepared;
        policy.prepare_into(joints, prepared);
        const AffineTransform<S> expected = policy.blend(prepared, row);
        for (int flipped = 0; flipped < 3; ++flipped) {
            MatrixX<S> other = prepared;
            other.col(flipped) = -other.col(flipped);
            const AffineTransform<S> T = policy.blend(other, row);
            CHECK(T.linear == expected.linear);
            CHECK(T.translation == expected.translation);
        }
    }
}

TEST_CASE("of several largest weights the lowest joint is the pivot, in any order of the row") {
    // Twists 0, +100 and -100 degrees: the two twisted ones are in each other's far hemisphere, so the pivot shows.
    std::vector<AffineTransform<double>> joints(3);
    const double a = 100 * std::numbers::pi / 180;
    joints[0].linear = rotation_matrix_from_rotation_vector(Eigen::Vector3d(a, 0, 0));
    joints[1].linear = rotation_matrix_from_rotation_vector(Eigen::Vector3d(-a, 0, 0));
    const std::vector<JointWeight<double>> row{{0, 0.4}, {1, 0.4}, {2, 0.2}}, reversed{{2, 0.2}, {1, 0.4}, {0, 0.4}};
    const double pivot_first = rotation_vector_from_rotation_matrix(blend(joints, row).linear)(0);
    const double pivot_last = rotation_vector_from_rotation_matrix(blend(joints, reversed).linear)(0);
    // pivot joint 0: -100 counts as 260, so the blend of half angles 50, 130 (0.4 each) and 0 (0.2)
    const double y = 0.4 * (std::sin(a / 2) + std::sin(std::numbers::pi - a / 2));
    const double x = 0.4 * (std::cos(a / 2) + std::cos(std::numbers::pi - a / 2)) + 0.2;
    CHECK(pivot_first == doctest::Approx(2 * std::atan2(y, x)).epsilon(1e-14));
    CHECK(pivot_last == doctest::Approx(pivot_first).epsilon(1e-14));
}

TEST_CASE("over two turns of twist the blend is continuous except at half turns, where it changes sides") {
    const double step = 2 * std::numbers::pi / 1000;
    // |d angle / d twist| = 2 |d q / d twist| / |q| <= 0.4 / 0.6 on the arcs where cos(twist/2) keeps its sign
    const double largest_step = 0.4 / 0.6 * step * 1.001;
    int jumps = 0;
    for (int k = 0; k < 2000; ++k) {
        const double before = blended_twist(k * step), after = blended_twist((k + 1) * step);
        const double turns = (k + 0.5) * step / (2 * std::numbers::pi);
        if (std::abs(turns - 0.5) < 0.0011 || std::abs(turns - 1.5) < 0.0011) {  // the steps that touch pi and 3 pi
            jumps += std::abs(after - before) > 2 * largest_step ? 1 : 0;
        } else {
            CAPTURE(turns);
            CHECK(std::abs(after - before) <= largest_step);
        }
    }
    CHECK(jumps == 2);
    // At the half turn: +-2 atan(0.4 / 0.6) on its two sides.
    const double side = 2 * std::atan2(0.4, 0.6);
    CHECK(blended_twist(std::numbers::pi - 1e-9) == doctest::Approx(side).epsilon(1e-8));
    CHECK(blended_twist(std::numbers::pi + 1e-9) == doctest::Approx(-side).epsilon(1e-8));
    for (const double twist : {0.3, 2.0, 4.0, 6.0}) {
        CHECK(blended_twist(twist + 2 * std::numbers::pi) == doctest::Approx(blended_twist(twist)).epsilon(1e-13));
    }
}

TEST_CASE_TEMPLATE("transforms that are not rigid are refused, with the joint", S, float, double) {
    const DualQuaternion<S> policy;
    MatrixX<S> prepared;
    for (const S scale : {S(1.01), S(-1), std::numeric_limits<S>::quiet_NaN()}) {
        std::vector<AffineTransform<S>> joints(3);
        joints[1].linear *= scale;
        CHECK_THROWS_WITH_AS(policy.prepare_into(joints, prepared),
                             "dual quaternion skinning: transform of joint 1 is not rigid, expected a rotation and a "
                             "translation",
                             InvalidInput);
    }
    std::vector<AffineTransform<S>> joints(1);
    joints[0].linear *= S(1.00002);  // 4e-5 in A^T A: single-precision data
    CHECK_NOTHROW(policy.prepare_into(joints, prepared));
}

TEST_CASE("agrees with independent software to 1e-10 m") {
    for (const std::string& name : softtissue_test::blend_reference_names) {
        if (!std::filesystem::exists(softtissue_test::blend_reference_path(name))) {
            MESSAGE("skipped: " << softtissue_test::blend_reference_path(name).string() << " is not here");
            continue;
        }
        CAPTURE(name);
        const softtissue_test::BlendReference reference(name);
        const double error = reference.largest_error(DualQuaternion<double>{}, "dqs");
        MESSAGE(name << ": largest error " << error << " m");
        CHECK(error <= 1e-10);
    }
}
