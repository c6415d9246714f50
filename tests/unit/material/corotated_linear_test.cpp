// SPDX-License-Identifier: MIT
#include <softtissue/material/corotated_linear.hpp>

#include <softtissue/linalg/symmetric_eigen.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

static_assert(HasProjectedHessian<CorotatedLinear<float>>);
static_assert(HasProjectedHessian<CorotatedLinear<double>>);

namespace {

template <class Scalar>
constexpr LameParameters<Scalar> lame = {Scalar(2e4), Scalar(9e4)};

}  // namespace

TEST_CASE_TEMPLATE("the energy is the quadratic form of its constant Hessian about F = R", Scalar, float, double) {
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        const Matrix3<Scalar> R = random_rotation<Scalar>(random);
        const CorotatedLinear<Scalar> material(lame<Scalar>, R);
        const Matrix9<Scalar> H = material.hessian(R);
        CHECK(H == H.transpose());
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<Scalar> difference = F - R;
            const Vector9<Scalar> d = vec(difference);
            const Vector9<Scalar> stress = vec(material.first_piola(F));
            CHECK(std::abs(material.energy_density(F) - d.dot(H * d) / Scalar(2)) <
                  Scalar(50) * epsilon * H.norm() * (F.squaredNorm() + Scalar(3)));
            CHECK((stress - H * d).norm() < Scalar(50) * epsilon * H.norm() * (F.norm() + Scalar(2)));
            CHECK(material.hessian(F) == H);
        }
    }
}

TEST_CASE_TEMPLATE("the Hessian has the eigenvalues of linear elasticity, none negative", Scalar, float, double) {
    RandomGenerator random(2);
    const Matrix3<Scalar> R = random_rotation<Scalar>(random);
    const CorotatedLinear<Scalar> material(lame<Scalar>, R);
    const Matrix9<Scalar> H = material.hessian(R);
    Vector9<Scalar> eigenvalues = symmetric_eigen(H).values;
    std::sort(eigenvalues.begin(), eigenvalues.end());
    Vector9<Scalar> expected = Vector9<Scalar>::Constant(Scalar(2) * lame<Scalar>.mu);
    expected.template head<3>().setZero();
    expected(8) += Scalar(3) * lame<Scalar>.lambda;
    CHECK((eigenvalues - expected).cwiseAbs().maxCoeff() <
          Scalar(30) * std::numeric_limits<Scalar>::epsilon() * expected(8));
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK(material.projected_hessian(R, filter) == H);
    }
}

TEST_CASE("uniaxial stress in the frame of R gives (E, nu)") {
    RandomGenerator random(3);
    const Matrix3<double> R = random_rotation<double>(random);
    const auto material = CorotatedLinear<double>::from_young_poisson({.young_modulus = 45e3, .poisson_ratio = 0.3}, R);
    const Vector3<double> stretch(1.01, 1 - 0.003, 1 - 0.003);
    const Matrix3<double> F = R * stretch.asDiagonal();
    const Matrix3<double> stress = R.transpose() * material.first_piola(F);
    CHECK(stress(0, 0) == doctest::Approx(450.0).epsilon(1e-10));
    CHECK(std::abs(stress(1, 1)) < 1e-9);
    CHECK(material.rotation() == R);
    CHECK(material.parameters().mu == lame_parameters<double>({45e3, 0.3}).mu);
}

TEST_CASE("what is refused") {
    const Matrix3<double> I = Matrix3<double>::Identity();
    CHECK_THROWS_AS(CorotatedLinear<double>({.mu = 0.0, .lambda = 1.0}, I), InvalidInput);
    CHECK_THROWS_AS(CorotatedLinear<double>({.mu = 3.0, .lambda = -2.0}, I), InvalidInput);
    CHECK_THROWS_AS(CorotatedLinear<double>::from_young_poisson({1.0, 0.5}, I), InvalidInput);
    CHECK_THROWS_WITH(CorotatedLinear<double>({.mu = 1.0, .lambda = 1.0}, -I), "det rotation = -1, expected +1");
    CHECK_THROWS_WITH(CorotatedLinear<double>({.mu = 1.0, .lambda = 1.0}, 2 * I),
                      "rotation: column 0 times column 0 = 4, expected 1 (orthonormal)");
}
