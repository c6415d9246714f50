// SPDX-License-Identifier: MIT
#include <softtissue/core/dual.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

static_assert(HasProjectedHessian<FungOrthotropic<float>>);
static_assert(HasProjectedHessian<FungOrthotropic<double>>);

namespace {

template <class Scalar>
FungOrthotropicParameters<Scalar> skin() {
    return {.normal_modulus = Scalar(1e4), .tangential_modulus = Scalar(3e4)};
}

/// The formulas of the file comment, second derivatives direction by direction, in double.
struct NaiveFung {
    FungOrthotropicCoefficients<double> c;
    Matrix3<double> B;

    double sum(const Matrix3<double>& M, const Matrix3<double>& N) const {
        return c.tau.cwiseProduct(M.cwiseProduct(N)).sum();
    }
    Matrix3<double> strain(const Matrix3<double>& F) const {
        return B.transpose() * (F.transpose() * F - Matrix3<double>::Identity()) / 2 * B;
    }
    /// sym(M^T N) in the frame of B.
    Matrix3<double> framed(const Matrix3<double>& M, const Matrix3<double>& N) const {
        return B.transpose() * (M.transpose() * N + N.transpose() * M) / 2 * B;
    }
    /// The exponential or its continuation, and their derivatives.
    Vector3<double> exponential(double x) const {
        const double m = c.max_exponent;
        const double d = x - m;
        return x < m ? Vector3<double>(std::exp(x), std::exp(x), std::exp(x))
                     : Vector3<double>(std::exp(m) * Vector3<double>(1 + d + d * d / 2, 1 + d, 1));
    }
    double energy(const Matrix3<double>& F) const {
        const Matrix3<double> E = strain(F);
        const double J = F.determinant();
        return c.mu * (exponential(c.eta * sum(E, E))(0) - 1) / c.eta + c.lambda / 2 * (J - 1) * (J - 1);
    }
    Matrix9<double> hessian(const Matrix3<double>& F) const {
        const Matrix3<double> E = strain(F);
        const Vector3<double> e = exponential(c.eta * sum(E, E));
        const Matrix3<double> cof = cofactor(F);
        Matrix9<double> H = c.lambda * vec(cof) * vec(cof).transpose();
        add_determinant_hessian(F, c.lambda * (F.determinant() - 1), H);
        for (int a = 0; a < 9; ++a) {
            for (int b = 0; b < 9; ++b) {
                const Matrix3<double> M = unvec<double>(Vector9<double>::Unit(a));
                const Matrix3<double> N = unvec<double>(Vector9<double>::Unit(b));
                const Matrix3<double> dM = framed(F, M);
                const Matrix3<double> dN = framed(F, N);
                H(a, b) += c.mu * (e(2) * c.eta * 4 * sum(E, dM) * sum(E, dN) +
                                   e(1) * 2 * (sum(dM, dN) + sum(E, framed(M, N))));
            }
        }
        return H;
    }
};

template <class Scalar>
NaiveFung naive(const FungOrthotropic<Scalar>& material) {
    const FungOrthotropicCoefficients<Scalar>& c = material.coefficients();
    return {{double(c.mu), double(c.lambda), c.tau.template cast<double>(), double(c.eta), double(c.max_exponent)},
            material.basis().template cast<double>()};
}

}  // namespace

TEST_CASE("coefficients of words") {
    // E / (2 (1 + nu)) = E / 2.5 and E nu / ((1 + nu) (1 - 2 nu)) = E / 2 for nu = 0.25.
    const FungOrthotropicCoefficients<double> soft_across = fung_coefficients<double>(
        {.normal_modulus = 1e4, .tangential_modulus = 4e4, .poisson_ratio = 0.25, .exponent = 7});
    CHECK(soft_across.mu == doctest::Approx(16e3));
    CHECK(soft_across.lambda == doctest::Approx(16e3));
    CHECK(soft_across.eta == 7.0);
    Matrix3<double> tau;
    tau << 0.25, 1, 1, 1, 1, 1, 1, 1, 1;
    CHECK(soft_across.tau == tau);
    const FungOrthotropicCoefficients<double> stiff_across =
        fung_coefficients<double>({.normal_modulus = 4e4, .tangential_modulus = 1e4, .poisson_ratio = 0.25});
    tau << 1, 1, 1, 1, 0.25, 0.25, 1, 0.25, 0.25;
    CHECK(stiff_across.tau == tau);
    CHECK(stiff_across.mu == soft_across.mu);
    CHECK(stiff_across.eta == 4.0);
    CHECK(FungOrthotropicParameters<double>().poisson_ratio == 0.2);
}

TEST_CASE_TEMPLATE("energy and Hessian are the formulas of the file comment", Scalar, float, double) {
    constexpr double epsilon = double(std::numeric_limits<Scalar>::epsilon());
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        if (state_class == StateClass::large_stretch) {
            continue;  // above the continuation in float; both sides are checked below
        }
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 6; ++repeat) {
            const FungOrthotropic<Scalar> material(skin<Scalar>(), random_rotation<Scalar>(random));
            const Matrix3<Scalar> F = random_state<Scalar>(state_class, random);
            const Matrix3<double> G = F.template cast<double>();
            const Matrix9<double> expected = naive(material).hessian(G);
            const Matrix9<Scalar> H = material.hessian(F);
            const double scale = expected.cwiseAbs().maxCoeff() * (1 + G.squaredNorm());
            // An error of the exponent x is one of x epsilon in its exponential.
            const Matrix3<double> E = naive(material).strain(G);
            const double tolerance = 40 * epsilon * (1 + 4 * E.squaredNorm()) * scale;
            CHECK(H == H.transpose());
            CHECK((H.template cast<double>() - expected).cwiseAbs().maxCoeff() < tolerance);
            CHECK(std::abs(double(material.energy_density(F)) - naive(material).energy(G)) < tolerance);
            for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
                CHECK(material.projected_hessian(F, filter) == filtered(H, filter));
            }
        }
    }
}

TEST_CASE_TEMPLATE("both sides of the continuation: value, stress and Hessian pass it without a jump", Scalar, float,
                   double) {
    FungOrthotropicParameters<Scalar> parameters = skin<Scalar>();
    parameters.max_exponent = Scalar(2);
    RandomGenerator random(2);
    const FungOrthotropic<Scalar> material(parameters, random_rotation<Scalar>(random));
    FungOrthotropicParameters<Scalar> free_parameters = skin<Scalar>();
    const FungOrthotropic<Scalar> exponential(free_parameters, material.basis());
    const NaiveFung formula = naive(material);
    const Matrix3<Scalar> D = random_normal<Matrix3<Scalar>>(random);
    const auto F = [&](double t) { return Matrix3<Scalar>(Matrix3<Scalar>::Identity() + Scalar(t) * D); };
    const auto exponent = [&](double t) {
        const Matrix3<double> E = formula.strain(F(t).template cast<double>());
        return formula.c.eta * formula.sum(E, E);
    };
    double low = 0;
    double high = 1;
    while (exponent(high) < 2) {
        high *= 2;
    }
    for (int bisection = 0; bisection < 60; ++bisection) {
        (exponent((low + high) / 2) < 2 ? low : high) = (low + high) / 2;
    }
    for (const double t : {0.5 * low, 0.9 * low, 1.1 * high, 2 * high}) {
        const Matrix9<double> expected = formula.hessian(F(t).template cast<double>());
        const double scale = expected.cwiseAbs().maxCoeff();
        CHECK((material.hessian(F(t)).template cast<double>() - expected).cwiseAbs().maxCoeff() <
              1000 * double(std::numeric_limits<Scalar>::epsilon()) * scale);
        CHECK(double(material.energy_density(F(t))) ==
              doctest::Approx(formula.energy(F(t).template cast<double>())).epsilon(1e-4));
        CHECK((material.hessian(F(t)) == exponential.hessian(F(t))) == (t < high));
    }
    // Just above, continuation and exponential differ by the cube of the excess only.
    const double above = high * (1 + 1e-3);
    const double excess = exponent(above) - 2;
    CHECK(excess > 0);
    CHECK(excess < 0.05);
    const double error = double((material.hessian(F(above)) - exponential.hessian(F(above))).norm()) /
                         double(exponential.hessian(F(above)).norm());
    CHECK(error < 2 * excess);  // second derivative: first order in the excess
    const double stress_error = double((material.first_piola(F(above)) - exponential.first_piola(F(above))).norm()) /
                                double(exponential.first_piola(F(above)).norm());
    CHECK(stress_error < excess * excess + 100 * double(std::numeric_limits<Scalar>::epsilon()));
}

TEST_CASE_TEMPLATE("strains far beyond the exponential's range stay finite and grow", Scalar, float, double) {
    const FungOrthotropic<Scalar> material(skin<Scalar>(), Matrix3<Scalar>::Identity());
    RandomGenerator random(3);
    const Matrix3<Scalar> D = random_unit<Matrix3<Scalar>>(random);
    Scalar last = Scalar(0);
    for (const double size : {1.0, 3.0, 10.0, 100.0}) {
        const Matrix3<Scalar> F = Matrix3<Scalar>::Identity() + Scalar(size) * D;
        const Scalar psi = material.energy_density(F);
        CHECK(std::isfinite(psi));
        CHECK(psi > last);
        CHECK(material.first_piola(F).allFinite());
        CHECK(material.hessian(F).allFinite());
        CHECK(material.projected_hessian(F, PsdFilter::clamp).allFinite());
        last = psi;
    }
    constexpr Scalar default_max = FungOrthotropicParameters<Scalar>::default_max_exponent;
    CHECK(double(std::exp(default_max)) ==
          doctest::Approx(std::sqrt(double(std::numeric_limits<Scalar>::max()))).epsilon(1e-3));
}

TEST_CASE_TEMPLATE("small energies keep their digits", Scalar, float, double) {
    // At F = R (1 + d) psi = mu sigma + lambda/2 (3 d)^2 to first order: exp - 1 would lose all of sigma = 1e-8 in float.
    const FungOrthotropic<double> reference(skin<double>(), Matrix3<double>::Identity());
    const FungOrthotropic<Scalar> material(skin<Scalar>(), Matrix3<Scalar>::Identity());
    const Scalar d = Scalar(0x1p-13);  // 1 + d and its square are exact in float up to the last bit
    Matrix3<Scalar> F = Matrix3<Scalar>::Identity();
    F(0, 1) = d;  // simple shear: J = 1
    CHECK(double(material.energy_density(F)) ==
          doctest::Approx(reference.energy_density(F.template cast<double>())).epsilon(1e-6));
}

TEST_CASE("rest is free of stress; small strain is orthotropic linear elasticity") {
    RandomGenerator random(4);
    const Matrix3<double> B = random_rotation<double>(random);
    const FungOrthotropic<double> material(skin<double>(), B);
    const Matrix3<double> I = Matrix3<double>::Identity();
    CHECK(material.energy_density(I) == 0.0);
    CHECK(material.first_piola(I) == Matrix3<double>::Zero());
    const FungOrthotropicCoefficients<double>& c = material.coefficients();
    for (int k = 0; k < 9; ++k) {
        const Matrix3<double> D = unvec<double>(Vector9<double>::Unit(k));
        const Matrix3<double> e = B.transpose() * (D + D.transpose()) / 2 * B;
        const Matrix3<double> in_basis = 2 * c.mu * c.tau.cwiseProduct(e) + c.lambda * e.trace() * I;
        const Matrix3<double> stress = B * in_basis * B.transpose();
        CHECK((material.hessian(I) * vec(D) - vec(stress)).norm() < 1e-10);
    }
}

TEST_CASE_TEMPLATE("the symmetry group: turns about the normal and flips of each axis, nothing else", Scalar, float,
                   double) {
    RandomGenerator random(5);
    const Matrix3<Scalar> B = random_rotation<Scalar>(random);
    const Matrix3<Scalar> F = random_state<Scalar>(StateClass::near_identity, random);
    const FungOrthotropic<Scalar> material(skin<Scalar>(), B);
    const double psi = double(material.energy_density(F));
    const double tolerance = 2000 * double(std::numeric_limits<Scalar>::epsilon());
    for (int axis = 0; axis < 3; ++axis) {
        Matrix3<Scalar> flipped = B;
        flipped.col(axis) *= Scalar(-1);
        const FungOrthotropic<Scalar> same(skin<Scalar>(), flipped);
        CHECK(double(same.energy_density(F)) == doctest::Approx(psi).epsilon(tolerance));
    }
    // 90 degrees about the normal exchange the tangential axes; any other exchange is seen.
    Matrix3<Scalar> exchanged = B;
    exchanged.col(1).swap(exchanged.col(2));
    CHECK(double(FungOrthotropic<Scalar>(skin<Scalar>(), exchanged).energy_density(F)) ==
          doctest::Approx(psi).epsilon(tolerance));
    exchanged.col(0).swap(exchanged.col(1));
    CHECK(std::abs(double(FungOrthotropic<Scalar>(skin<Scalar>(), exchanged).energy_density(F)) - psi) > 1e-3 * psi);
}

TEST_CASE("the law can be evaluated with numbers that carry derivatives") {
    RandomGenerator random(6);
    const Matrix3<double> B = random_rotation<double>(random);
    const FungOrthotropic<double> material(skin<double>(), B);
    using Number = Dual<double, 9>;
    const FungOrthotropic<Number> lifted({.normal_modulus = Number(1e4), .tangential_modulus = Number(3e4)},
                                         B.cast<Number>());
    for (const StateClass state_class : {StateClass::general, StateClass::large_stretch, StateClass::inverted}) {
        const Matrix3<double> F = random_state<double>(state_class, random);
        Matrix3<Number> variables;
        for (int k = 0; k < 9; ++k) {
            variables(k) = Number::variable(F(k), k);
        }
        const Number psi = lifted.energy_density(variables);
        const Matrix3<double> P = material.first_piola(F);
        CHECK(psi.value == doctest::Approx(material.energy_density(F)).epsilon(1e-13));
        for (int k = 0; k < 9; ++k) {
            CHECK(std::abs(psi.derivative[size_t(k)] - P(k)) < 1e-12 * P.norm());
        }
    }
}

TEST_CASE("what is refused") {
    const Matrix3<double> I = Matrix3<double>::Identity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refuses = [&](FungOrthotropicParameters<double> parameters) {
        CHECK_THROWS_AS(FungOrthotropic<double>(parameters, I), InvalidInput);
    };
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        refuses({.normal_modulus = bad, .tangential_modulus = 1.0});
        refuses({.normal_modulus = 1.0, .tangential_modulus = bad});
        refuses({.normal_modulus = 1.0, .tangential_modulus = 1.0, .exponent = bad});
        refuses({.normal_modulus = 1.0, .tangential_modulus = 1.0, .max_exponent = bad});
    }
    for (const double bad : {-1.0, 0.5, nan}) {
        refuses({.normal_modulus = 1.0, .tangential_modulus = 1.0, .poisson_ratio = bad});
    }
    CHECK_THROWS_WITH(FungOrthotropic<double>({.normal_modulus = 1.0, .tangential_modulus = -2.0}, I),
                      "tangential_modulus = -2, expected positive and finite");
    CHECK_THROWS_WITH(FungOrthotropic<double>(skin<double>(), 2 * I),
                      "basis: column 0 times column 0 = 4, expected 1 (orthonormal)");
    FungOrthotropicParameters<float> too_far = skin<float>();
    too_far.max_exponent = 89.0f;
    CHECK_THROWS_AS(FungOrthotropic<float>(too_far, Matrix3<float>::Identity()), InvalidInput);
    too_far.max_exponent = 88.0f;
    CHECK_NOTHROW(FungOrthotropic<float>(too_far, Matrix3<float>::Identity()));
}
