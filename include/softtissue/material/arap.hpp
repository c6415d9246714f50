// SPDX-License-Identifier: MIT
/// @file
/// As-rigid-as-possible law: the squared distance of F from the nearest rotation.
///
/// What        energy density, first Piola stress, Hessian, projected Hessian in closed form
/// Equation    psi = k |F - R|^2,   R = R(F) the nearest proper rotation
/// Shapes      F, P: 3x3.  H: 9x9 on column-major vec(F).
/// Units       psi, P, H, k in Pa; F dimensionless
/// Parameters  stiffness k (1 by default).  Small-strain limit: Lamé's parameters mu = k, lambda = 0.
/// Valid       every F, det F <= 0 included; P and H only where R is differentiable: s_1 + s_2 > 0 for the two smallest
///             signed singular values.  Towards that set the twist eigenvalue of H falls to -infinity as
///             2 k (1 - 2 / (s_1 + s_2)); on it the sum is kept at epsilon, so that H stays finite.
///             Refuses k <= 0 (InvalidInput).
/// Source      Sorkine, Alexa 2007; eigensystem: Smith, de Goes, Kim 2019, sec. 4
/// Departs     no weight 1/2: the factor of the paper's per-edge sum is in k
/// Cost        one polar_rotation; Hessian: one svd3 and one isotropic_hessian
/// Tests       tests/unit/material/arap_test.cpp
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
class Arap {
public:
    using Scalar = ScalarType;

    /// The coefficient of the energy, see the file comment.
    struct Parameters {
        Scalar stiffness = Scalar(1);  ///< [Pa]
    };

    explicit Arap(const Parameters& parameters = {}) : stiffness_(parameters.stiffness) {
        require_positive_modulus(stiffness_, "stiffness");
    }

    /// For data that was checked before: nothing is.
    static Arap unchecked(const Parameters& parameters) { return Arap(parameters, Unchecked{}); }

    /// N laws side by side, law(i) in lane i.
    template <int N, class Law>
    static Arap<Pack<Scalar, N>> packed(const Law& law) requires RealScalar<Scalar> {
        return Arap<Pack<Scalar, N>>::unchecked(
            {.stiffness = Pack<Scalar, N>::from_lanes([&](int i) { return law(i).stiffness_; })});
    }

    Parameters parameters() const { return {.stiffness = stiffness_}; }

    Scalar energy_density(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).energy; }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).stress; }

    EnergyAndStress<Scalar> energy_and_first_piola(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> strain = F - polar_rotation(F);
        return {stiffness_ * strain.squaredNorm(), Scalar(2) * stiffness_ * strain};
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const { return projected_hessian(F, PsdFilter::none); }

    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter filter) const {
        const Svd3<Scalar> svd = svd3(F);
        return isotropic_hessian(svd, filtered(spectrum(svd.sigma), filter));
    }

    /// Second derivatives in the frame of the signed singular values.
    IsotropicSpectrum<Scalar> spectrum(const Vector3<Scalar>& sigma) const {
        const Scalar twice = Scalar(2) * stiffness_;
        IsotropicSpectrum<Scalar> result;
        result.A = twice * Matrix3<Scalar>::Identity();
        for (int k = 0; k < 3; ++k) {
            result.twist(k) = twice - Scalar(2) * twice / twist_denominator(sigma, (k + 1) % 3, (k + 2) % 3);
            result.flip(k) = twice;
        }
        return result;
    }

private:
    struct Unchecked {};
    Arap(const Parameters& parameters, Unchecked) : stiffness_(parameters.stiffness) {}

    Scalar stiffness_;
};

}  // namespace softtissue
