// SPDX-License-Identifier: MIT
#include <softtissue/material/from_energy.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/dual.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/material/concepts.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <concepts>
#include <limits>

using namespace softtissue;

namespace {

/// Neo-Hookean energy whose derivatives are known in closed form.
struct NeoHookean {
    double mu = 2;
    double lambda = 5;

    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        const S J = F.determinant();
        return S(mu / 2) * F.squaredNorm() - S(mu) * J + S(lambda / 2) * (J - S(1)) * (J - S(1));
    }
};

/// Exponential in the stretch of a fibre; calls functions unqualified and mixes in plain numbers.
struct Fibre {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        using std::exp;
        using std::sqrt;
        const S stretch = sqrt(F.col(0).squaredNorm());
        return exp(stretch - 1);
    }
};

struct WithoutEnergy {};
struct InDoubleOnly {
    double energy_density(const Eigen::Matrix3d& F) const { return F.squaredNorm(); }
};
struct LosesDerivatives {
    template <class S>
    double energy_density(const Eigen::Matrix<S, 3, 3>&) const {
        return 0;
    }
};
struct NotConst {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) {
        return F.squaredNorm();
    }
};

template <class S>
Matrix3<S> sample_matrix() {
    Matrix3<S> F;
    F << S(1.1), S(0.2), S(-0.3), S(0.4), S(0.9), S(0.1), S(-0.2), S(0.5), S(1.3);
    return F;
}

}  // namespace

static_assert(HyperelasticMaterial<FromEnergy<NeoHookean>> && HyperelasticMaterial<FromEnergy<NeoHookean, float>>);
static_assert(!HasProjectedHessian<FromEnergy<NeoHookean>>, "the generic eigenvalue filter serves it");
static_assert(std::same_as<FromEnergy<NeoHookean>::Scalar, double>);
static_assert(std::same_as<decltype(FromEnergy{NeoHookean{}}), FromEnergy<NeoHookean, double>>);
static_assert(EnergyDensityOnly<NeoHookean> && EnergyDensityOnly<NeoHookean, float> && EnergyDensityOnly<Fibre>);
static_assert(!EnergyDensityOnly<WithoutEnergy> && !EnergyDensityOnly<InDoubleOnly>);
static_assert(!EnergyDensityOnly<LosesDerivatives> && !EnergyDensityOnly<NotConst>);

TEST_CASE_TEMPLATE("stress and Hessian are those of the closed form", S, float, double) {
    const FromEnergy<NeoHookean, S> material{{.mu = 3, .lambda = 7}};
    const S mu = 3;
    const S lambda = 7;
    const Matrix3<S> F = sample_matrix<S>();
    const S J = F.determinant();
    const Matrix3<S> cofactor = J * F.inverse().transpose();
    const S tolerance = 64 * std::numeric_limits<S>::epsilon();

    const Matrix3<S> P = mu * F + (lambda * (J - 1) - mu) * cofactor;
    CHECK((material.first_piola(F) - P).norm() <= tolerance * P.norm());

    // H D = mu D + lambda (cof : D) cof + (lambda (J - 1) - mu) dcof(D); cof is quadratic in F, so its central
    // difference over a step of 1 is exact.
    const Matrix9<S> H = material.hessian(F);
    for (int k = 0; k < 9; ++k) {
        const Matrix3<S> D = unvec<S>(Vector9<S>::Unit(k));
        const auto cofactor_of = [](const Matrix3<S>& G) {
            Matrix3<S> c;
            for (int j = 0; j < 3; ++j) {
                c.col(j) = G.col((j + 1) % 3).cross(G.col((j + 2) % 3));
            }
            return c;
        };
        const Matrix3<S> dcofactor = (cofactor_of(F + D) - cofactor_of(F - D)) / S(2);
        const Matrix3<S> expected =
            mu * D + lambda * cofactor.cwiseProduct(D).sum() * cofactor + (lambda * (J - 1) - mu) * dcofactor;
        CHECK((unvec<S>(H.col(k)) - expected).norm() <= tolerance * H.norm());
    }
}

TEST_CASE_TEMPLATE("the energy is the user's and the Hessian exactly symmetric", S, float, double) {
    const Matrix3<S> F = sample_matrix<S>();
    const FromEnergy<Fibre, S> material;
    CHECK(material.energy_density(F) == Fibre{}.energy_density(F));
    CHECK(material.hessian(F) == Matrix9<S>(material.hessian(F).transpose()));
    const S stretch = F.col(0).norm();
    Matrix3<S> P = Matrix3<S>::Zero();
    P.col(0) = std::exp(stretch - 1) / stretch * F.col(0);
    CHECK((material.first_piola(F) - P).norm() <= 64 * std::numeric_limits<S>::epsilon() * P.norm());
}

TEST_CASE("parameters of the user's energy stay reachable") {
    FromEnergy material{NeoHookean{.mu = 4}};
    const Matrix3<double> F = sample_matrix<double>();
    const double before = material.energy_density(F);
    material.energy.mu = 8;
    CHECK(material.energy_density(F) != before);
}

TEST_CASE("a material from an energy can itself be differentiated, by its parameters or by F") {
    using D = Dual<double, 1>;
    const FromEnergy<NeoHookean, D> material;
    Matrix3<D> F = sample_matrix<double>().cast<D>();
    F(1, 2) = D::variable(F(1, 2).value, 0);
    const Matrix9<double> H = FromEnergy<NeoHookean>{}.hessian(sample_matrix<double>());
    const Matrix3<D> P = material.first_piola(F);
    for (int k = 0; k < 9; ++k) {
        CHECK(P.data()[k].derivative[0] == doctest::Approx(H(k, 1 + 3 * 2)).epsilon(1e-14));
    }
}
