// SPDX-License-Identifier: MIT
#include <softtissue/material/arap.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <type_traits>

using namespace softtissue;

static_assert(HasProjectedHessian<Arap<float>>);
static_assert(HasProjectedHessian<Arap<double>>);
static_assert(!std::is_convertible_v<double, Arap<double>>);

TEST_CASE_TEMPLATE("the energy is the squared distance of the singular values from 1", Scalar, float, double) {
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Scalar expected = Scalar(3) * (svd3(F).sigma.array() - Scalar(1)).square().sum();
            // F - R is known to epsilon |F|; its square loses twice that.
            const Scalar tolerance =
                Scalar(60) * std::numeric_limits<Scalar>::epsilon() * (F.squaredNorm() + Scalar(3));
            CHECK(std::abs(Arap<Scalar>({.stiffness = Scalar(3)}).energy_density(F) - expected) < tolerance);
        }
    }
}

TEST_CASE_TEMPLATE("the Hessian is 2 k (I - dR/dF), and its filter that of the 9x9 matrix", Scalar, float, double) {
    constexpr Scalar tolerance = Scalar(200) * std::numeric_limits<Scalar>::epsilon();
    const Arap<Scalar> material({.stiffness = Scalar(3)});
    RandomGenerator random(2);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix9<Scalar> expected = Scalar(6) * (Matrix9<Scalar>::Identity() - drotation_dgradient(F));
            const Matrix9<Scalar> H = material.hessian(F);
            const Scalar scale = H.cwiseAbs().maxCoeff();
            CHECK(H == H.transpose());
            CHECK((H - expected).cwiseAbs().maxCoeff() < tolerance * scale);
            for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
                const Matrix9<Scalar> projected = material.projected_hessian(F, filter);
                CHECK((projected - filtered(H, filter)).cwiseAbs().maxCoeff() < tolerance * scale);
            }
        }
    }
}

TEST_CASE("a reflection is pulled to the nearest rotation, not to itself") {
    const Matrix3<double> reflection = Vector3<double>(1, 1, -1).asDiagonal();
    CHECK(Arap<double>().energy_density(reflection) == 4.0);
    CHECK(Arap<double>().energy_density(Matrix3<double>::Identity()) == 0.0);
    CHECK(Arap<double>().first_piola(Matrix3<double>::Identity()) == Matrix3<double>::Zero());
}

TEST_CASE_TEMPLATE("the twist eigenvalue follows the stated law up to the singular set, and is finite on it", Scalar,
                   float, double) {
    const Arap<Scalar> material;
    for (const Scalar sum : {Scalar(3), Scalar(2), Scalar(1), Scalar(1e-2), Scalar(1e-4)}) {
        const Scalar twist = material.spectrum({Scalar(2), Scalar(1), sum - Scalar(1)}).twist(0);
        CHECK(double(twist) == doctest::Approx(2 - 4 / double(sum)).epsilon(1e-2));
    }
    const Matrix3<Scalar> singular = Vector3<Scalar>(Scalar(2), Scalar(1), Scalar(-1)).asDiagonal();
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK(material.projected_hessian(singular, filter).allFinite());
        CHECK(material.projected_hessian(Matrix3<Scalar>::Zero(), filter).allFinite());
    }
    // Clamped, the mode has no stiffness; nothing of its size before is left.
    CHECK(material.projected_hessian(singular, PsdFilter::clamp).cwiseAbs().maxCoeff() < Scalar(2.001));
    CHECK(material.first_piola(singular).allFinite());
}

TEST_CASE("what is refused") {
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL}) {
        CHECK_THROWS_AS(Arap<double>({.stiffness = bad}), InvalidInput);
    }
    CHECK_THROWS_WITH(Arap<double>({.stiffness = -1}), "stiffness = -1, expected positive and finite");
    CHECK(Arap<double>().parameters().stiffness == 1.0);
}
