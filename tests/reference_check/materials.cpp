// SPDX-License-Identifier: MIT
// Point laws: energy density, first Piola stress, Hessian and projected Hessian of every stored sample.
#include "cell_materials.hpp"
#include "reference_case.hpp"

#include <softtissue/material/arap.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <functional>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double law_tolerance = 1e-11;
constexpr double projection_tolerance = 1e-9;

/// |H| with the eigenvalues of the stored Hessian: the reference for the absolute filter.
Matrix9<double> absolute_value(const Matrix9<double>& H) {
    const Eigen::SelfAdjointEigenSolver<Matrix9<double>> eigen(H);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseAbs().asDiagonal() * eigen.eigenvectors().transpose();
}

template <class MaterialOfSample>
void check_law(const ReferenceCase& reference, const MaterialOfSample& material_of, Checklist& checks) {
    const auto F = reference.file.at("F").matrices<double, 3, 3>();
    const auto P = reference.file.at("P").matrices<double, 3, 3>();
    const auto H = reference.file.at("H").matrices<double, 9, 9>();
    const auto H_clamped = reference.file.at("H_psd").matrices<double, 9, 9>();
    const VectorX<double> energy = reference.file.at("energy").vector<double>();
    double energy_error = 0.0, stress_error = 0.0, hessian_error = 0.0, clamp_error = 0.0, absolute_error = 0.0;
    for (size_t i = 0; i < F.size(); ++i) {
        const auto material = material_of(Index(i));
        const double scale = H[i].cwiseAbs().maxCoeff();
        // near rest energy and stress vanish to second and first order: their natural unit there is the stiffness
        energy_error = std::max(energy_error, std::abs(material.energy_density(F[i]) - energy(Index(i))) /
                                                  std::max(std::abs(energy(Index(i))), scale));
        stress_error = std::max(stress_error, relative_difference(material.first_piola(F[i]), P[i],
                                                                  std::max(P[i].cwiseAbs().maxCoeff(), scale)));
        hessian_error = std::max(hessian_error, relative_difference(material.hessian(F[i]), H[i], scale));
        clamp_error = std::max(clamp_error, relative_difference(projected_hessian(material, F[i], PsdFilter::clamp),
                                                                H_clamped[i], scale));
        absolute_error = std::max(absolute_error,
                                  relative_difference(projected_hessian(material, F[i], PsdFilter::absolute),
                                                      absolute_value(H[i]), scale));
    }
    checks.add(reference.name, "energy density", energy_error, law_tolerance);
    checks.add(reference.name, "first Piola stress", stress_error, law_tolerance);
    checks.add(reference.name, "Hessian", hessian_error, law_tolerance);
    checks.add(reference.name, "Hessian, clamped", clamp_error, projection_tolerance);
    checks.add(reference.name, "Hessian, absolute", absolute_error, projection_tolerance);
}

bool is_law(const ReferenceCase& reference, const char* law) { return reference.name.find(law) != std::string::npos; }

}  // namespace

void check_material(const ReferenceCase& reference, Checklist& checks) {
    if (is_law(reference, "arap")) {
        check_law(reference, [](Index) { return Arap<double>(); }, checks);
        return;
    }
    const VectorX<double> mu = reference.file.at("mu").vector<double>();
    const VectorX<double> lambda = reference.file.at("lam").vector<double>();
    if (is_law(reference, "snh")) {
        check_law(reference, [&](Index i) { return StableNeoHookean<double>({.mu = mu(i), .lambda = lambda(i)}); }, checks);
    } else if (is_law(reference, "fung")) {
        const VectorX<double> eta = reference.file.at("eta").vector<double>();
        const auto tau = reference.file.at("tau").matrices<double, 3, 3>();
        const auto B = reference.file.at("B").matrices<double, 3, 3>();
        check_law(reference,
                  [&](Index i) { return fung_orthotropic(mu(i), lambda(i), eta(i), tau[size_t(i)], B[size_t(i)]); }, checks);
    } else if (is_law(reference, "corot_fixed")) {
        const auto R = reference.file.at("R").matrices<double, 3, 3>();
        check_law(reference,
                  [&](Index i) { return CorotatedLinear<double>({.mu = mu(i), .lambda = lambda(i)}, R[size_t(i)]); }, checks);
    } else if (is_law(reference, "corot_polar")) {
        check_law(reference, [&](Index i) { return CorotatedLinearPolar<double>({.mu = mu(i), .lambda = lambda(i)}); },
                  checks);
    } else {
        checks.skip(reference.name, "no material of this name");
    }
}

}  // namespace reference_check
