// SPDX-License-Identifier: MIT
/// @file
/// Stable neo-Hookean law: isotropic, volume-preserving, smooth through inversion.
///
/// What        energy density, first Piola stress, Hessian, projected Hessian in closed form
/// Equation    psi = mu/2 (|F|^2 - 3) + lambda/2 (J - alpha)^2,   alpha = 1 + mu/lambda
/// Shapes      F, P: 3x3.  H: 9x9 on column-major vec(F).
/// Units       psi, P, H, mu, lambda in Pa; F dimensionless
/// Parameters  (mu, lambda) of THIS energy, whose small-strain limit has Lamé's parameters (mu, lambda - mu).
///             from_young_poisson() shifts lambda so that the small-strain limit is (E, nu);
///             from_textbook_lame() takes Lamé's lambda of (E, nu) unshifted: softer in volume than (E, nu)
/// Valid       every F, det F <= 0 included.  The rest state is stress-free, its energy is mu^2 / (2 lambda), not 0; it
///             is a minimum only if lambda > mu/3 (from_textbook_lame: nu > 1/8).  Refuses mu <= 0, lambda <= 0 (InvalidInput).
/// Source      Smith, de Goes, Kim 2018, "Stable Neo-Hookean Flesh Simulation"; Kim, Eberle 2020, "Dynamic Deformables"
/// Departs     without the logarithmic barrier of the 2018 energy: F = 0 has finite energy and no stress
/// Cost        energy 30 flop; stress 60; Hessian 250; projected Hessian one svd3 and one isotropic_hessian
/// Tests       tests/unit/material/stable_neo_hookean_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/svd3.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/material/isotropic_hessian.hpp>

namespace softtissue {

template <FieldScalar ScalarType>
class StableNeoHookean {
public:
    using Scalar = ScalarType;

    /// The coefficients [Pa] of the energy, see the file comment.
    struct Parameters {
        Scalar mu;
        Scalar lambda;
    };

    explicit StableNeoHookean(const Parameters& parameters) : mu_(parameters.mu), lambda_(parameters.lambda) {
        require_positive_modulus(mu_, "mu");
        require_positive_modulus(lambda_, "lambda");
    }

    /// The law whose small-strain limit is (E, nu): lambda = lambda_Lamé + mu.
    static StableNeoHookean from_young_poisson(const YoungPoisson<Scalar>& constants) {
        const LameParameters<Scalar> lame = lame_parameters(constants);
        return StableNeoHookean({.mu = lame.mu, .lambda = lame.lambda + lame.mu});
    }

    /// The law with Lamé's parameters of (E, nu) as its coefficients; needs nu > 0.
    static StableNeoHookean from_textbook_lame(const YoungPoisson<Scalar>& constants) {
        const LameParameters<Scalar> lame = lame_parameters(constants);
        return StableNeoHookean({.mu = lame.mu, .lambda = lame.lambda});
    }

    /// For data that was checked before: nothing is.
    static StableNeoHookean unchecked(const Parameters& parameters) {
        StableNeoHookean result;
        result.mu_ = parameters.mu;
        result.lambda_ = parameters.lambda;
        return result;
    }

    /// N laws side by side, law(i) in lane i.
    template <int N, class Law>
    static StableNeoHookean<Pack<Scalar, N>> packed(const Law& law) requires RealScalar<Scalar> {
        using Lanes = Pack<Scalar, N>;
        return StableNeoHookean<Lanes>::unchecked({.mu = Lanes::from_lanes([&](int i) { return law(i).mu_; }),
                                                   .lambda = Lanes::from_lanes([&](int i) { return law(i).lambda_; })});
    }

    Parameters parameters() const { return {.mu = mu_, .lambda = lambda_}; }

    Scalar energy_density(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).energy; }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).stress; }

    EnergyAndStress<Scalar> energy_and_first_piola(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> cof = cofactor(F);
        const Scalar J = determinant(F, cof);
        const Scalar pressure = volume_stress(J);
        return {(mu_ * (F.squaredNorm() - Scalar(3)) + pressure * (J - Scalar(1) - mu_ / lambda_)) / Scalar(2),
                mu_ * F + pressure * cof};
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> cof = cofactor(F);
        const Vector9<Scalar> g = vec(cof);
        const Vector9<Scalar> lambda_g = lambda_ * g;
        Matrix9<Scalar> H;
        for (int column = 0; column < 9; ++column) {
            for (int row = column; row < 9; ++row) {
                H(row, column) = H(column, row) = lambda_g(row) * g(column);
            }
            H(column, column) += mu_;
        }
        add_determinant_hessian(F, volume_stress(determinant(F, cof)), H);
        return H;
    }

    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter filter) const requires RealLanes<Scalar> {
        if (filter == PsdFilter::none) {
            return hessian(F);
        }
        const Svd3<Scalar> svd = svd3(F);
        return isotropic_hessian(svd, filtered(spectrum(svd.sigma), filter));
    }

    /// Second derivatives in the frame of the signed singular values.
    IsotropicSpectrum<Scalar> spectrum(const Vector3<Scalar>& sigma) const {
        const Scalar J = sigma(0) * sigma(1) * sigma(2);
        const Scalar pressure = volume_stress(J);
        IsotropicSpectrum<Scalar> result;
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3;
            const int j = (k + 2) % 3;
            const Scalar area = sigma(i) * sigma(j);  // dJ / ds_k
            result.A(k, k) = mu_ + lambda_ * area * area;
            result.A(i, j) = result.A(j, i) = (pressure + lambda_ * J) * sigma(k);
            result.twist(k) = mu_ + pressure * sigma(k);
            result.flip(k) = mu_ - pressure * sigma(k);
        }
        return result;
    }

private:
    StableNeoHookean() = default;

    /// lambda (J - alpha), written so that rest is free of stress to the last bit.
    Scalar volume_stress(const Scalar& J) const { return lambda_ * (J - Scalar(1)) - mu_; }

    Scalar mu_;
    Scalar lambda_;
};

}  // namespace softtissue
