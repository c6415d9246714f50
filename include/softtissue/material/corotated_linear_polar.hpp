// SPDX-License-Identifier: MIT
/// @file
/// Linear elasticity measured in the frame of the nearest rotation of F itself.
///
/// What        energy density, first Piola stress, Hessian (the rotation varies with F), projected Hessian in closed form
/// Equation    psi = mu |F - R|^2 + lambda/2 tr(R^T F - I)^2,   R = R(F) the nearest proper rotation
/// Shapes      F, P: 3x3.  H: 9x9 on column-major vec(F).
/// Units       psi, P, H, mu, lambda in Pa; F dimensionless
/// Parameters  Lamé's (mu, lambda); small-strain limit: the same, thus (E, nu)
/// Valid       every F, det F <= 0 included; P and H only where R is differentiable: s_1 + s_2 > 0 for the two smallest
///             signed singular values (see polar.hpp); on that set H is finite.  Volume change is penalised only to first
///             order.  Refuses mu <= 0, 2 mu + 3 lambda <= 0 (InvalidInput).
/// Source      Müller, Gross 2004, "Interactive Virtual Materials"; eigensystem: Smith, de Goes, Kim 2019, sec. 4
/// Cost        one polar_rotation; Hessian: one svd3 and one isotropic_hessian
/// Tests       tests/unit/material/corotated_linear_polar_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/svd3.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/material/isotropic_hessian.hpp>

namespace softtissue {

template <RealLanes ScalarType>
class CorotatedLinearPolar {
public:
    using Scalar = ScalarType;
    using Parameters = LameParameters<Scalar>;

    explicit CorotatedLinearPolar(const Parameters& parameters) : lame_(parameters) {
        require_positive_definite(lame_);
    }

    /// The law of (E, nu).
    static CorotatedLinearPolar from_young_poisson(const YoungPoisson<Scalar>& constants) {
        return CorotatedLinearPolar(lame_parameters(constants));
    }

    /// For data that was checked before: nothing is.
    static CorotatedLinearPolar unchecked(const Parameters& parameters) {
        CorotatedLinearPolar result;
        result.lame_ = parameters;
        return result;
    }

    /// N laws side by side, law(i) in lane i.
    template <int N, class Law>
    static CorotatedLinearPolar<Pack<Scalar, N>> packed(const Law& law) requires RealScalar<Scalar> {
        using Lanes = Pack<Scalar, N>;
        const LameParameters<Lanes> lame{.mu = Lanes::from_lanes([&](int i) { return law(i).lame_.mu; }),
                                         .lambda = Lanes::from_lanes([&](int i) { return law(i).lame_.lambda; })};
        return CorotatedLinearPolar<Lanes>::unchecked(lame);
    }

    Parameters parameters() const { return lame_; }

    Scalar energy_density(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).energy; }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).stress; }

    EnergyAndStress<Scalar> energy_and_first_piola(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> R = polar_rotation(F);
        const Matrix3<Scalar> strain = F - R;
        const Scalar trace = F.cwiseProduct(R).sum() - Scalar(3);  // tr(R^T F - I)
        const Scalar pressure = lame_.lambda * trace;
        return {lame_.mu * strain.squaredNorm() + pressure * trace / Scalar(2),
                Scalar(2) * lame_.mu * strain + pressure * R};
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const { return projected_hessian(F, PsdFilter::none); }

    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter filter) const {
        const Svd3<Scalar> svd = svd3(F);
        return isotropic_hessian(svd, filtered(spectrum(svd.sigma), filter));
    }

    /// Second derivatives in the frame of the signed singular values.
    IsotropicSpectrum<Scalar> spectrum(const Vector3<Scalar>& sigma) const {
        const Scalar twice_mu = Scalar(2) * lame_.mu;
        // p_i = 2 mu s_i + rest, the same `rest` for all three.
        const Scalar rest = lame_.lambda * (sigma.sum() - Scalar(3)) - twice_mu;
        IsotropicSpectrum<Scalar> result;
        result.A = Matrix3<Scalar>::Constant(lame_.lambda);
        result.A.diagonal().array() += twice_mu;
        for (int k = 0; k < 3; ++k) {
            result.twist(k) = twice_mu + Scalar(2) * rest / twist_denominator(sigma, (k + 1) % 3, (k + 2) % 3);
            result.flip(k) = twice_mu;
        }
        return result;
    }

private:
    CorotatedLinearPolar() = default;

    LameParameters<Scalar> lame_;
};

}  // namespace softtissue
