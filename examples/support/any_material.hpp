// SPDX-License-Identifier: MIT
/// @file
/// A material chosen while the program runs: one of the library's laws behind one type.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace examples {

/// Satisfies softtissue::HyperelasticMaterial by asking whichever law it holds.
template <class S>
struct AnyMaterial {
    using Scalar = S;
    std::variant<softtissue::FungOrthotropic<S>, softtissue::StableNeoHookean<S>, softtissue::CorotatedLinearPolar<S>,
                 softtissue::Arap<S>>
        law;

    S energy_density(const softtissue::Matrix3<S>& F) const {
        return std::visit([&](const auto& material) { return material.energy_density(F); }, law);
    }
    softtissue::Matrix3<S> first_piola(const softtissue::Matrix3<S>& F) const {
        return std::visit([&](const auto& material) { return material.first_piola(F); }, law);
    }
    softtissue::Matrix9<S> hessian(const softtissue::Matrix3<S>& F) const {
        return std::visit([&](const auto& material) { return material.hessian(F); }, law);
    }
    softtissue::Matrix9<S> projected_hessian(const softtissue::Matrix3<S>& F, softtissue::PsdFilter filter) const {
        return std::visit([&](const auto& material) { return material.projected_hessian(F, filter); }, law);
    }
};

/// Satisfies softtissue::MaterialField.
template <class S>
struct AnyMaterialField {
    std::variant<softtissue::FungOrthotropicField<S>, softtissue::UniformField<AnyMaterial<S>>> field;

    AnyMaterial<S> at(softtissue::Index cell) const {
        return std::visit([&](const auto& cells) { return AnyMaterial<S>{cells.at(cell)}; }, field);
    }
};

/// Moduli of the skin: Romero et al. 2020 fix nu = 0.2 and eta = 4 and estimate Y_N and Y_T, of the order of these.
inline constexpr double normal_modulus = 5e3;       // [Pa]
inline constexpr double tangential_modulus = 10e3;  // [Pa]
inline constexpr double poisson_ratio = 0.2;
inline constexpr double exponent = 4.0;
// The law is quadratic in eta sigma from here on (strains of 100 % and more), so that cells which skinning alone has crushed
// do not outweigh all others by a hundred powers of ten.
inline constexpr double max_exponent = 12.0;

/// `name` is fung, snh, corotated or arap; the isotropic ones take the mean of the two moduli. `bases`: one per cell.
template <class S>
AnyMaterialField<S> make_material_field(const std::string& name, const std::vector<softtissue::Matrix3<S>>& bases) {
    using namespace softtissue;
    const S young_modulus = S(0.5 * (normal_modulus + tangential_modulus));
    const LameParameters<S> lame = lame_parameters<S>({young_modulus, S(poisson_ratio)});
    const auto uniform = [](auto material) {
        return AnyMaterialField<S>{UniformField<AnyMaterial<S>>{AnyMaterial<S>{std::move(material)}}};
    };
    if (name == "fung") {
        typename FungOrthotropicField<S>::Bases columns(9, Index(bases.size()));
        for (size_t c = 0; c < bases.size(); ++c) {
            columns.col(Index(c)) = vec(bases[c]);
        }
        return {FungOrthotropicField<S>({.normal_modulus = S(normal_modulus),
                                         .tangential_modulus = S(tangential_modulus),
                                         .poisson_ratio = S(poisson_ratio),
                                         .exponent = S(exponent),
                                         .max_exponent = S(max_exponent)},
                                        columns)};
    }
    if (name == "snh") {
        return uniform(StableNeoHookean<S>::from_young_poisson({young_modulus, S(poisson_ratio)}));
    }
    if (name == "corotated") {
        return uniform(CorotatedLinearPolar<S>(lame));
    }
    require(name == "arap", "material = ", name, ", expected fung, snh, corotated or arap");
    return uniform(Arap<S>({.stiffness = lame.mu}));
}

}  // namespace examples
