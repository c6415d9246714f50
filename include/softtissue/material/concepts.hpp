// SPDX-License-Identifier: MIT
/// @file
/// What a material is: a small value that maps F to energy density, stress and Hessian.
///
/// HyperelasticMaterial   `using Scalar`, energy_density(F) [J/m^3], first_piola(F) [Pa], hessian(F) 9x9 [Pa] on column-major vec(F)
/// HasEnergyAndFirstPiola also energy_and_first_piola(F): both at once, where they share work
/// HasProjectedHessian    also projected_hessian(F, PsdFilter): eigenvalues of the 9x9 Hessian filtered, in closed form where one exists
/// MaterialField          a law per cell: at(cell) returns a material or a reference to one
///
/// Laws (softtissue/testing/material_laws.hpp): stress is the derivative of the energy and the Hessian that of
/// the stress (Taylor rates), H symmetric, objectivity, P(I) = 0, stated small-strain limit, projected H >= 0.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace softtissue {

template <class M>
concept HyperelasticMaterial =
    std::copy_constructible<M> && requires(const M& m, const Matrix3<typename M::Scalar>& F) {
        { m.energy_density(F) } -> std::same_as<typename M::Scalar>;
        { m.first_piola(F) } -> std::same_as<Matrix3<typename M::Scalar>>;
        { m.hessian(F) } -> std::same_as<Matrix9<typename M::Scalar>>;
    };

/// Energy density [J/m^3] and first Piola stress [Pa] at one F.
template <FieldScalar Scalar>
struct EnergyAndStress {
    Scalar energy;
    Matrix3<Scalar> stress;
};

template <class M>
concept HasEnergyAndFirstPiola =
    HyperelasticMaterial<M> && requires(const M& m, const Matrix3<typename M::Scalar>& F) {
        { m.energy_and_first_piola(F) } -> std::same_as<EnergyAndStress<typename M::Scalar>>;
    };

/// Energy density and stress at F.
template <HyperelasticMaterial M>
EnergyAndStress<typename M::Scalar> energy_and_first_piola(const M& material, const Matrix3<typename M::Scalar>& F) {
    if constexpr (HasEnergyAndFirstPiola<M>) {
        return material.energy_and_first_piola(F);
    } else {
        return {material.energy_density(F), material.first_piola(F)};
    }
}

template <class M>
concept HasProjectedHessian =
    HyperelasticMaterial<M> && requires(const M& m, const Matrix3<typename M::Scalar>& F, PsdFilter filter) {
        { m.projected_hessian(F, filter) } -> std::same_as<Matrix9<typename M::Scalar>>;
    };

/// The Hessian at F with its negative eigenvalues treated as `filter` says; a numeric 9x9 eigen-decomposition
/// where the material has no projection of its own.
template <HyperelasticMaterial M>
Matrix9<typename M::Scalar> projected_hessian(const M& material, const Matrix3<typename M::Scalar>& F,
                                              PsdFilter filter) {
    if (filter == PsdFilter::none) {
        return material.hessian(F);
    }
    if constexpr (HasProjectedHessian<M>) {
        return material.projected_hessian(F, filter);
    } else {
        return filtered(material.hessian(F), filter);
    }
}

/// The material type of a field.
template <class Field>
using MaterialOf = std::remove_cvref_t<decltype(std::declval<const Field&>().at(Index(0)))>;

/// A material per cell.
template <class Field>
concept MaterialField =
    requires(const Field& field, Index cell) { field.at(cell); } && HyperelasticMaterial<MaterialOf<Field>>;

}  // namespace softtissue
