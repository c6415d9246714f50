// SPDX-License-Identifier: MIT
/// @file
/// Fung-orthotropic skin law: stiffness that grows exponentially with strain, different along and across the skin.
///
/// What        energy density, first Piola stress, analytic Hessian, its eigenvalue filter
/// Equation    psi = mu (exp(eta sigma) - 1) / eta + lambda/2 (J - 1)^2,   sigma = sum_ij tau_ij Eb_ij^2 over all nine (i, j),
///             Eb = B^T E B,   E = (F^T F - I) / 2
/// Shapes      F, P, B: 3x3.  H: 9x9 on column-major vec(F).
/// Units       psi, P, H, moduli in Pa; F, B, eta dimensionless
/// Parameters  Y_N along the first column of B (the skin's normal), Y_T along the other two, nu, eta (> 0).
///             Y = max(Y_N, Y_T): mu = Y / (2 (1 + nu)), lambda = Y nu / ((1 + nu) (1 - 2 nu)), tau_00 = Y_N / Y,
///             tau_11 = tau_22 = Y_T / Y, tau_ij = max(tau_ii, tau_jj).
///             Small-strain limit: psi = mu sum tau_ij e_ij^2 + lambda/2 tr(e)^2 in the frame of B; (Y, nu) where Y_N = Y_T.
/// Valid       every F, det F <= 0 included, though the volume term does not resist inversion.  Above eta sigma = max_exponent
///             the exponential continues as its second-order Taylor polynomial (C2), so that values stay finite.
///             Refuses moduli <= 0, nu outside (-1, 0.5), eta <= 0, max_exponent outside (0, log(largest finite)],
///             B not orthonormal to 1e-5 (InvalidInput).  The handedness of B has no effect.
/// Source      Romero et al. 2020, eq. (4) and (5)
/// Departs     continuation of the exponential; expm1 in place of exp - 1
/// Cost        energy 120 flop, stress 250 flop, an exponential for both; Hessian 1200 flop + 1; projection: a Cholesky
///             factorisation where H is positive definite, else its negative eigenpairs (negative_eigenpairs.hpp)
/// Tests       tests/unit/material/fung_orthotropic_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/material/orthonormal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace softtissue {

/// Stiffness of skin in words; see fung_orthotropic.hpp for the conversion to coefficients.
template <FieldScalar Scalar>
struct FungOrthotropicParameters {
    using Real = RealOf<Scalar>;
    /// exp(x) up to here is at most the square root of the largest finite number, which leaves its products room.
    static constexpr Real default_max_exponent =
        Real(std::numeric_limits<Real>::max_exponent) * std::numbers::ln2_v<Real> / Real(2);

    Scalar normal_modulus;      ///< Y_N [Pa]
    Scalar tangential_modulus;  ///< Y_T [Pa]
    Scalar poisson_ratio = Scalar(0.2);
    Scalar exponent = Scalar(4);               ///< eta, how fast the stiffness grows with squared strain
    Real max_exponent = default_max_exponent;  ///< eta sigma above which the exponential becomes quadratic
};

/// The numbers that the energy is evaluated with.
template <FieldScalar Scalar>
struct FungOrthotropicCoefficients {
    Scalar mu;            ///< [Pa]
    Scalar lambda;        ///< [Pa]
    Matrix3<Scalar> tau;  ///< symmetric, entries in (0, 1]
    Scalar eta;
    Scalar max_exponent;

    /// The same in every lane, or in another precision.
    template <FieldScalar To>
    FungOrthotropicCoefficients<To> cast() const {
        return {static_cast<To>(mu), static_cast<To>(lambda), tau.template cast<To>(), static_cast<To>(eta),
                static_cast<To>(max_exponent)};
    }
};

/// Those of coefficients(i) in lane i.
template <int N, class CoefficientsOf>
auto packed_fung_coefficients(const CoefficientsOf& coefficients) {
    using Lanes = Pack<std::remove_cvref_t<decltype(coefficients(0).mu)>, N>;
    return FungOrthotropicCoefficients<Lanes>{
        .mu = Lanes::from_lanes([&](int i) { return coefficients(i).mu; }),
        .lambda = Lanes::from_lanes([&](int i) { return coefficients(i).lambda; }),
        .tau = packed_matrix<N>([&](int i) { return coefficients(i).tau; }),
        .eta = Lanes::from_lanes([&](int i) { return coefficients(i).eta; }),
        .max_exponent = Lanes::from_lanes([&](int i) { return coefficients(i).max_exponent; })};
}

/// The coefficients of `parameters`; refuses what the file comment lists. `where...` precedes the names in the message.
template <FieldScalar Scalar, class... Where>
FungOrthotropicCoefficients<Scalar> fung_coefficients(const FungOrthotropicParameters<Scalar>& parameters,
                                                      const Where&... where) {
    using Real = RealOf<Scalar>;
    require_positive_modulus(parameters.normal_modulus, where..., "normal_modulus");
    require_positive_modulus(parameters.tangential_modulus, where..., "tangential_modulus");
    require_poisson_ratio(parameters.poisson_ratio, where..., "poisson_ratio");
    require_positive_modulus(parameters.exponent, where..., "exponent");
    const Real max_exponent = parameters.max_exponent;
    constexpr Real largest = Real(2) * FungOrthotropicParameters<Scalar>::default_max_exponent;
    require(max_exponent > Real(0) && max_exponent <= largest, where..., "max_exponent = ", max_exponent,
            ", expected > 0 and <= ", largest);

    const bool is_stiff_in_normal = value_of(parameters.normal_modulus) > value_of(parameters.tangential_modulus);
    const Scalar Y = is_stiff_in_normal ? parameters.normal_modulus : parameters.tangential_modulus;
    const LameParameters<Scalar> lame = lame_parameters<Scalar>({Y, parameters.poisson_ratio});
    FungOrthotropicCoefficients<Scalar> result;
    result.mu = lame.mu;
    result.lambda = lame.lambda;
    result.eta = parameters.exponent;
    result.max_exponent = Scalar(max_exponent);
    // The larger of any two different diagonal weights is 1, that of the two tangential ones their own.
    const Scalar tangential = parameters.tangential_modulus / Y;
    result.tau.setConstant(tangential);
    result.tau(0, 0) = parameters.normal_modulus / Y;
    for (int j = 1; j < 3; ++j) {
        result.tau(0, j) = result.tau(j, 0) = Scalar(1);
    }
    return result;
}

template <FieldScalar ScalarType>
class FungOrthotropic {
public:
    using Scalar = ScalarType;
    using Parameters = FungOrthotropicParameters<Scalar>;
    using Coefficients = FungOrthotropicCoefficients<Scalar>;

    /// `basis`: orthonormal columns, the first along the skin's normal.
    FungOrthotropic(const Parameters& parameters, const Matrix3<Scalar>& basis)
        : coefficients_(fung_coefficients(parameters)), basis_(basis) {
        require_orthonormal(basis, "basis");
    }

    /// For data that was checked before: nothing is.
    FungOrthotropic(const Coefficients& coefficients, const Matrix3<Scalar>& basis)
        : coefficients_(coefficients), basis_(basis) {}

    /// N laws side by side, law(i) in lane i.
    template <int N, class Law>
    static FungOrthotropic<Pack<Scalar, N>> packed(const Law& law) requires RealScalar<Scalar> {
        return {packed_fung_coefficients<N>([&](int i) { return law(i).coefficients_; }),
                packed_matrix<N>([&](int i) { return law(i).basis_; })};
    }

    const Coefficients& coefficients() const { return coefficients_; }
    const Matrix3<Scalar>& basis() const { return basis_; }

    Scalar energy_density(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).energy; }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const { return energy_and_first_piola(F).stress; }

    EnergyAndStress<Scalar> energy_and_first_piola(const Matrix3<Scalar>& F) const {
        using std::expm1;
        const Scalar one(1), two(2);
        const Matrix3<Scalar> Eb = strain(F);
        const Exponent x = exponent(Eb);
        const Scalar growth = expm1(x.within);
        const Scalar exponential = one + growth;  // growth >= 0: no digit is lost
        const Scalar continued = exponential * x.excess * (one + x.excess / two);
        const Matrix3<Scalar> cof = cofactor(F);
        const Scalar dilation = determinant(F, cof) - one;
        const Scalar pressure = coefficients_.lambda * dilation;
        const Scalar dpsi_dsigma = coefficients_.mu * exponential * (one + x.excess);
        const Matrix3<Scalar> S = dpsi_dsigma * dsigma_dstrain(Eb);
        return {coefficients_.mu * (growth + continued) / coefficients_.eta + pressure * dilation / two,
                F * S + pressure * cof};
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const {
        using std::exp;
        const Matrix3<Scalar> Eb = strain(F);
        const Exponent x = exponent(Eb);
        const Scalar d2psi_dsigma2_over_eta = coefficients_.mu * exp(x.within);
        const Scalar dpsi_dsigma = d2psi_dsigma2_over_eta * (Scalar(1) + x.excess);
        const Matrix3<Scalar> T = dsigma_dstrain(Eb);
        const Matrix3<Scalar> cof = cofactor(F);

        // H = sum_k w_k m_k m_k^T + I (x) S + lambda (J - 1) d2J/dF2, with eight modes m:
        // dsigma/dF, dJ/dF, and dEb_ab/dF for the six strains.
        Modes modes;
        Weights weights;
        modes.col(0) = vec<Scalar>(F * T);
        weights(0) = coefficients_.eta * d2psi_dsigma2_over_eta;
        modes.col(1) = vec(cof);
        weights(1) = coefficients_.lambda;
        add_strain_modes(F * basis_, dpsi_dsigma, modes, weights);
        Matrix9<Scalar> H = sum_of_squares(modes, weights);
        for (int j = 0; j < 3; ++j) {
            for (int l = 0; l < 3; ++l) {
                for (int i = 0; i < 3; ++i) {
                    H(i + 3 * j, i + 3 * l) += dpsi_dsigma * T(j, l);
                }
            }
        }
        add_determinant_hessian(F, Scalar(coefficients_.lambda * (determinant(F, cof) - Scalar(1))), H);
        return H;
    }

    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter filter) const requires RealLanes<Scalar> {
        return filtered(hessian(F), filter);
    }

private:
    /// eta sigma, split where the exponential becomes quadratic: excess = 0 below.
    struct Exponent {
        Scalar within;
        Scalar excess;
    };

    Matrix3<Scalar> strain(const Matrix3<Scalar>& F) const {
        Matrix3<Scalar> E = F.transpose() * F;
        E.diagonal().array() -= Scalar(1);
        E /= Scalar(2);
        return basis_.transpose() * E * basis_;
    }

    Exponent exponent(const Matrix3<Scalar>& Eb) const {
        const Scalar x = coefficients_.eta * coefficients_.tau.cwiseProduct(Eb.cwiseProduct(Eb)).sum();
        const Scalar within = select(x < coefficients_.max_exponent, x, coefficients_.max_exponent);
        return {within, x - within};
    }

    /// dsigma/dE = 2 B (tau o Eb) B^T, symmetric to the last bit.
    Matrix3<Scalar> dsigma_dstrain(const Matrix3<Scalar>& Eb) const {
        const Matrix3<Scalar> half = basis_ * coefficients_.tau.cwiseProduct(Eb) * basis_.transpose();
        return half + half.transpose();
    }

    static constexpr int num_modes = 8;
    using Modes = Eigen::Matrix<Scalar, 9, num_modes>;
    using Weights = Eigen::Matrix<Scalar, num_modes, 1>;

    /// The modes and weights 2 to 7 of the Hessian: dpsi/dsigma d2sigma/dEb2, one term for each of the six strains.
    void add_strain_modes(const Matrix3<Scalar>& FB, const Scalar& dpsi_dsigma, Modes& modes, Weights& weights) const {
        int mode = 2;
        for (int a = 0; a < 3; ++a) {
            for (int b = a; b < 3; ++b, ++mode) {
                // dEb_ab/dF = (f_a b_b^T + f_b b_a^T) / 2 with the columns f of F B; of the two equal off-diagonal
                // strains each has weight 2 tau.
                weights(mode) = dpsi_dsigma * coefficients_.tau(a, b) * (a == b ? Scalar(2) : Scalar(4));
                for (int j = 0; j < 3; ++j) {
                    for (int i = 0; i < 3; ++i) {
                        modes(i + 3 * j, mode) = (FB(i, a) * basis_(j, b) + FB(i, b) * basis_(j, a)) / Scalar(2);
                    }
                }
            }
        }
    }

    /// sum_k weights_k modes_k modes_k^T.
    static Matrix9<Scalar> sum_of_squares(const Modes& modes, const Weights& weights) {
        Matrix9<Scalar> H;
        for (int column = 0; column < 9; ++column) {
            for (int row = column; row < 9; ++row) {
                Scalar sum = Scalar(0);
                for (int k = 0; k < num_modes; ++k) {
                    sum += modes(row, k) * (weights(k) * modes(column, k));
                }
                H(row, column) = H(column, row) = sum;
            }
        }
        return H;
    }

    Coefficients coefficients_;
    Matrix3<Scalar> basis_;
};

}  // namespace softtissue
