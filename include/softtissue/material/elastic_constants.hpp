// SPDX-License-Identifier: MIT
/// @file
/// The two ways to state a linear isotropic stiffness, and the conversion between them.
///
/// What        YoungPoisson (E, nu) and LameParameters (mu, lambda)
/// Equation    mu = E / (2 (1 + nu)),  lambda = E nu / ((1 + nu) (1 - 2 nu))
/// Units       E, mu, lambda in Pa; nu dimensionless
/// Refuses     E <= 0, nu outside (-1, 0.5), mu <= 0, 2 mu + 3 lambda <= 0, NaN, infinity, E or nu for which mu or lambda is
///             infinite (InvalidInput)
/// Tests       tests/unit/material/elastic_constants_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/scalar.hpp>

#include <limits>

namespace softtissue {

/// Young's modulus [Pa] and Poisson's ratio [-].
template <FieldScalar Scalar>
struct YoungPoisson {
    Scalar young_modulus;
    Scalar poisson_ratio;
};

/// Lamé's parameters [Pa] of linear elasticity: psi = mu |e|^2 + lambda/2 tr(e)^2.
template <FieldScalar Scalar>
struct LameParameters {
    Scalar mu;
    Scalar lambda;
};

/// Refuses a modulus that is not positive and finite; the parts of its name are streamed into the message.
template <FieldScalar Scalar, class... Name>
void require_positive_modulus(const Scalar& modulus, const Name&... name) {
    using Real = RealOf<Scalar>;
    const Real value = value_of(modulus);
    require(value > Real(0) && value <= std::numeric_limits<Real>::max(), name..., " = ", value,
            ", expected positive and finite");
}

/// Refuses a Poisson's ratio outside the open interval (-1, 0.5).
template <FieldScalar Scalar, class... Name>
void require_poisson_ratio(const Scalar& poisson_ratio, const Name&... name) {
    using Real = RealOf<Scalar>;
    const Real value = value_of(poisson_ratio);
    require(value > Real(-1) && value < Real(0.5), name..., " = ", value, ", expected > -1 and < 0.5");
}

/// Refuses Lamé's parameters whose energy is not positive definite; `where...` precedes the names in the message.
template <FieldScalar Scalar, class... Where>
void require_positive_definite(const LameParameters<Scalar>& lame, const Where&... where) {
    using Real = RealOf<Scalar>;
    require_positive_modulus(lame.mu, where..., "mu");
    const Real lambda = value_of(lame.lambda);
    require(lambda > Real(-2) / Real(3) * value_of(lame.mu) && lambda <= std::numeric_limits<Real>::max(), where...,
            "lambda = ", lambda, ", expected > -2/3 mu = ", Real(-2) / Real(3) * value_of(lame.mu), " and finite");
}

/// (mu, lambda) of (E, nu).
template <FieldScalar Scalar>
LameParameters<Scalar> lame_parameters(const YoungPoisson<Scalar>& constants) {
    require_positive_modulus(constants.young_modulus, "young_modulus");
    require_poisson_ratio(constants.poisson_ratio, "poisson_ratio");
    const Scalar E = constants.young_modulus;
    const Scalar nu = constants.poisson_ratio;
    const LameParameters<Scalar> lame{E / (Scalar(2) * (Scalar(1) + nu)),
                                      E * nu / ((Scalar(1) + nu) * (Scalar(1) - Scalar(2) * nu))};
    using std::abs;
    constexpr RealOf<Scalar> largest = std::numeric_limits<RealOf<Scalar>>::max();
    require(value_of(lame.mu) <= largest && abs(value_of(lame.lambda)) <= largest, "young_modulus = ", value_of(E),
            " and poisson_ratio = ", value_of(nu), " give mu = ", value_of(lame.mu),
            ", lambda = ", value_of(lame.lambda), ", expected finite numbers");
    return lame;
}

/// (E, nu) of (mu, lambda).
template <FieldScalar Scalar>
YoungPoisson<Scalar> young_poisson(const LameParameters<Scalar>& lame) {
    require_positive_definite(lame);
    const Scalar mu = lame.mu;
    const Scalar lambda = lame.lambda;
    return {mu * (Scalar(3) * lambda + Scalar(2) * mu) / (lambda + mu), lambda / (Scalar(2) * (lambda + mu))};
}

}  // namespace softtissue
