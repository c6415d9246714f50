// SPDX-License-Identifier: MIT
/// @file
/// The materials that a reference case describes, one per cell or sample.
#pragma once

#include "reference_case.hpp"

#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <vector>

namespace reference_check {

inline softtissue::CellField<softtissue::StableNeoHookean<double>> stable_neo_hookean_field(const ReferenceCase& reference,
                                                                                            Index num_cells) {
    const softtissue::VectorX<double> mu = reference.file.at("mu").vector<double>();
    const softtissue::VectorX<double> lambda = reference.file.at("lam").vector<double>();
    std::vector<softtissue::StableNeoHookean<double>> cells;
    for (Index c = 0; c < num_cells; ++c) {
        cells.emplace_back(softtissue::StableNeoHookean<double>::Parameters{.mu = mu(c), .lambda = lambda(c)});
    }
    return softtissue::CellField<softtissue::StableNeoHookean<double>>(std::move(cells));
}

/// Every case stores mu, lambda, eta, tau and B.
inline softtissue::FungOrthotropic<double> fung_orthotropic(double mu, double lambda, double eta,
                                                            const softtissue::Matrix3<double>& tau,
                                                            const softtissue::Matrix3<double>& B) {
    using Parameters = softtissue::FungOrthotropic<double>::Parameters;
    return {{.mu = mu, .lambda = lambda, .tau = tau, .eta = eta, .max_exponent = Parameters::default_max_exponent}, B};
}

inline softtissue::CellField<softtissue::FungOrthotropic<double>> fung_orthotropic_field(const ReferenceCase& reference,
                                                                                         Index num_cells) {
    const softtissue::VectorX<double> mu = reference.file.at("mu").vector<double>();
    const softtissue::VectorX<double> lambda = reference.file.at("lam").vector<double>();
    const double eta = reference.scalar("eta");
    const softtissue::Matrix3<double> tau = reference.file.at("tau").matrix<double>();
    const auto bases = reference.file.at("B").matrices<double, 3, 3>();
    std::vector<softtissue::FungOrthotropic<double>> cells;
    for (Index c = 0; c < num_cells; ++c) {
        cells.push_back(fung_orthotropic(mu(c), lambda(c), eta, tau, bases[size_t(c)]));
    }
    return softtissue::CellField<softtissue::FungOrthotropic<double>>(std::move(cells));
}

}  // namespace reference_check
