// SPDX-License-Identifier: MIT
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <type_traits>

using namespace softtissue;

static_assert(HasProjectedHessian<StableNeoHookean<float>>);
static_assert(HasProjectedHessian<StableNeoHookean<double>>);
static_assert(!std::is_constructible_v<StableNeoHookean<double>, double, double>);

namespace {

constexpr double mu = 2e4;
constexpr double lambda = 9e4;

template <class Scalar>
StableNeoHookean<Scalar> sample() {
    return StableNeoHookean<Scalar>({.mu = Scalar(mu), .lambda = Scalar(lambda)});
}

/// H(I) of linear elasticity.
Matrix9<double> linear_elasticity(const LameParameters<double>& lame) {
    Matrix9<double> H;
    for (int k = 0; k < 9; ++k) {
        const Matrix3<double> D = unvec<double>(Vector9<double>::Unit(k));
        const Matrix3<double> stress =
            lame.mu * (D + D.transpose()) + lame.lambda * D.trace() * Matrix3<double>::Identity();
        H.col(k) = vec(stress);
    }
    return H;
}

}  // namespace

TEST_CASE_TEMPLATE("the energy is the formula of the file comment", Scalar, float, double) {
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<double> G = F.template cast<double>();
            const double volume = G.determinant() - (1 + mu / lambda);
            const double expected = mu / 2 * (G.squaredNorm() - 3) + lambda / 2 * volume * volume;
            const double scale = mu * (G.squaredNorm() + 3) + lambda * volume * volume;
            CHECK(std::abs(double(sample<Scalar>().energy_density(F)) - expected) <
                  20 * double(std::numeric_limits<Scalar>::epsilon()) * scale);
        }
    }
}

TEST_CASE_TEMPLATE("rest is free of stress to the last bit, with the stated energy", Scalar, float, double) {
    const Matrix3<Scalar> I = Matrix3<Scalar>::Identity();
    CHECK(sample<Scalar>().first_piola(I) == Matrix3<Scalar>::Zero());
    CHECK(double(sample<Scalar>().energy_density(I)) == doctest::Approx(mu * mu / (2 * lambda)).epsilon(1e-6));
    CHECK(sample<Scalar>().first_piola(Matrix3<Scalar>::Zero()) == Matrix3<Scalar>::Zero());
}

TEST_CASE("the small-strain limits are those of the two constructors") {
    const YoungPoisson<double> constants = {.young_modulus = 45e3, .poisson_ratio = 0.47};
    const LameParameters<double> lame = lame_parameters(constants);
    const Matrix3<double> I = Matrix3<double>::Identity();

    const Matrix9<double> exact = StableNeoHookean<double>::from_young_poisson(constants).hessian(I);
    CHECK((exact - linear_elasticity(lame)).norm() < 1e-14 * exact.norm());

    const StableNeoHookean<double> textbook = StableNeoHookean<double>::from_textbook_lame(constants);
    CHECK(textbook.parameters().mu == lame.mu);
    CHECK(textbook.parameters().lambda == lame.lambda);
    const Matrix9<double> softer = textbook.hessian(I);
    CHECK((softer - linear_elasticity({lame.mu, lame.lambda - lame.mu})).norm() < 1e-14 * softer.norm());
}

TEST_CASE("rest is a minimum only for lambda > mu / 3") {
    const Matrix3<double> I = Matrix3<double>::Identity();
    const auto dilation_stiffness = [&](const StableNeoHookean<double>& material) {
        return vec(I).dot(material.hessian(I) * vec(I));
    };
    CHECK(dilation_stiffness(StableNeoHookean<double>({.mu = 3.0, .lambda = 1.01})) > 0);
    CHECK(dilation_stiffness(StableNeoHookean<double>({.mu = 3.0, .lambda = 0.99})) < 0);
    CHECK(dilation_stiffness(StableNeoHookean<double>::from_textbook_lame({1.0, 0.126})) > 0);
    CHECK(dilation_stiffness(StableNeoHookean<double>::from_textbook_lame({1.0, 0.124})) < 0);
}

TEST_CASE_TEMPLATE("the spectrum gives the Hessian that is computed without it", Scalar, float, double) {
    constexpr Scalar tolerance = Scalar(100) * std::numeric_limits<Scalar>::epsilon();
    RandomGenerator random(2);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix9<Scalar> H = sample<Scalar>().hessian(F);
            const Scalar scale = H.cwiseAbs().maxCoeff();
            CHECK(H == H.transpose());
            CHECK(sample<Scalar>().projected_hessian(F, PsdFilter::none) == H);
            const Svd3<Scalar> svd = svd3(F);
            const Matrix9<Scalar> assembled = isotropic_hessian(svd, sample<Scalar>().spectrum(svd.sigma));
            CHECK((assembled - H).cwiseAbs().maxCoeff() < tolerance * scale);
            for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
                const Matrix9<Scalar> projected = sample<Scalar>().projected_hessian(F, filter);
                CHECK((projected - filtered(H, filter)).cwiseAbs().maxCoeff() < tolerance * scale);
            }
        }
    }
}

TEST_CASE("what is refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(StableNeoHookean<double>({.mu = bad, .lambda = 1.0}), InvalidInput);
        CHECK_THROWS_AS(StableNeoHookean<double>({.mu = 1.0, .lambda = bad}), InvalidInput);
        CHECK_THROWS_AS(StableNeoHookean<double>::from_young_poisson({bad, 0.3}), InvalidInput);
    }
    CHECK_THROWS_WITH(StableNeoHookean<double>({.mu = 1.0, .lambda = -2.0}),
                      "lambda = -2, expected positive and finite");
    CHECK_THROWS_AS(StableNeoHookean<double>::from_young_poisson({1.0, 0.5}), InvalidInput);
    CHECK_NOTHROW(StableNeoHookean<double>::from_young_poisson({1.0, -0.3}));
    CHECK_THROWS_AS(StableNeoHookean<double>::from_textbook_lame({1.0, 0.0}), InvalidInput);
}

TEST_CASE("NaN passes through") {
    Matrix3<double> F = Matrix3<double>::Identity();
    F(0, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(sample<double>().energy_density(F)));
    CHECK_FALSE(sample<double>().first_piola(F).allFinite());
    CHECK_FALSE(sample<double>().projected_hessian(F, PsdFilter::clamp).allFinite());
}
