// SPDX-License-Identifier: MIT
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

static_assert(HasProjectedHessian<CorotatedLinearPolar<float>>);
static_assert(HasProjectedHessian<CorotatedLinearPolar<double>>);

namespace {

template <class Scalar>
constexpr LameParameters<Scalar> lame = {Scalar(2e4), Scalar(9e4)};

}  // namespace

TEST_CASE_TEMPLATE("energy and stress are those of the law that is given the polar rotation", Scalar, float, double) {
    constexpr Scalar tolerance = Scalar(100) * std::numeric_limits<Scalar>::epsilon();
    const CorotatedLinearPolar<Scalar> material(lame<Scalar>);
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const CorotatedLinear<Scalar> given(lame<Scalar>, polar_rotation(F));
            const Scalar scale = lame<Scalar>.lambda * (F.squaredNorm() + Scalar(3));
            CHECK(std::abs(material.energy_density(F) - given.energy_density(F)) < tolerance * scale);
            CHECK((material.first_piola(F) - given.first_piola(F)).norm() < tolerance * scale);
        }
    }
}

TEST_CASE_TEMPLATE("the Hessian is that of the formula, and its filter that of the 9x9 matrix", Scalar, float, double) {
    constexpr Scalar tolerance = Scalar(200) * std::numeric_limits<Scalar>::epsilon();
    const Scalar mu = lame<Scalar>.mu;
    const Scalar lambda = lame<Scalar>.lambda;
    const CorotatedLinearPolar<Scalar> material(lame<Scalar>);
    RandomGenerator random(2);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<Scalar> R = polar_rotation(F);
            const Matrix9<Scalar> dR = drotation_dgradient(F);
            const Scalar trace = F.cwiseProduct(R).sum() - Scalar(3);
            // d tr(R^T F)/dF = R, because F : dR = 0.
            const Matrix9<Scalar> expected = Scalar(2) * mu * (Matrix9<Scalar>::Identity() - dR) +
                                             lambda * (vec(R) * vec(R).transpose() + trace * dR);
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

TEST_CASE("rest is free of stress, with the stiffness of (E, nu)") {
    const YoungPoisson<double> constants = {.young_modulus = 45e3, .poisson_ratio = 0.47};
    const Matrix3<double> I = Matrix3<double>::Identity();
    const auto material = CorotatedLinearPolar<double>::from_young_poisson(constants);
    CHECK(material.energy_density(I) == 0.0);
    CHECK(material.first_piola(I) == Matrix3<double>::Zero());
    const Matrix9<double> expected = CorotatedLinear<double>::from_young_poisson(constants, I).hessian(I);
    CHECK((material.hessian(I) - expected).norm() < 1e-14 * expected.norm());
    CHECK(material.parameters().lambda == lame_parameters(constants).lambda);
}

TEST_CASE_TEMPLATE("all is finite where the rotation is not unique", Scalar, float, double) {
    const CorotatedLinearPolar<Scalar> material(lame<Scalar>);
    const Matrix3<Scalar> singular = Vector3<Scalar>(Scalar(2), Scalar(1), Scalar(-1)).asDiagonal();
    for (const Matrix3<Scalar>& F : {singular, Matrix3<Scalar>(Matrix3<Scalar>::Zero())}) {
        CHECK(material.first_piola(F).allFinite());
        for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
            CHECK(material.projected_hessian(F, filter).allFinite());
        }
    }
}

TEST_CASE("what is refused") {
    CHECK_THROWS_AS(CorotatedLinearPolar<double>({.mu = -1.0, .lambda = 1.0}), InvalidInput);
    CHECK_THROWS_AS(CorotatedLinearPolar<double>({.mu = 3.0, .lambda = -2.0}), InvalidInput);
    CHECK_THROWS_AS(CorotatedLinearPolar<double>::from_young_poisson({-1.0, 0.3}), InvalidInput);
}
