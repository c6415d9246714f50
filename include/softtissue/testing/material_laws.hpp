// SPDX-License-Identifier: MIT
/// @file
/// The physics every material must obey, checked on seeded random states: one call proves a new material.
///
///     struct MyMaterial {
///         double mu = 1e4;
///         template <class S>
///         S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
///             const S J = F.determinant();
///             return mu * (F.squaredNorm() - 3 + (J - 2) * (J - 2) - 1);
///         }
///     };
///     const LawReport report = check_material_laws(FromEnergy<MyMaterial>{}, {.is_isotropic = true});
///     if (!report.all_passed()) { std::cerr << report.summary(); }
///
/// Laws        "finite"                   psi, P and H are finite
///             "stress rate"              P is the derivative of psi: Taylor order 2
///             "hessian rate"             H is the derivative of P: Taylor order 2
///             "hessian symmetry"         H = H^T
///             "objective energy"         psi(R F) = psi(F)
///             "objective stress"         P(R F) = R P(F)
///             "isotropic energy"         psi(F Q) = psi(F)
///             "rest stress"              P(I) = 0
///             "small strain"             H(I) is the linear elasticity of the stated Lamé parameters
///             "projection positive"      no eigenvalue of the filtered H is negative, for clamp and absolute
///             "projection spectrum"      the filtered H is that of a numeric eigen-decomposition
///             "projection unchanged"     where H has no negative eigenvalue, filtering leaves it as it is
/// Measures    relative to |H| (stress: |H| |F|, energy: |psi| + |H| |F|^2), the size of the terms that cancel in them,
///             |.| the sum of absolute entries; the tolerance is MaterialLawOptions::round_off epsilons of the scalar
/// Tests       tests/laws/material_laws_test.cpp, tests/unit/testing/material_laws_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/symmetric_eigen.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/testing/law_report.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace softtissue {

/// Which laws a material claims to obey, and where.
struct MaterialLawOptions {
    /// The states the material is made for; a law with a barrier leaves out the inverted ones.
    std::vector<StateClass> states{all_state_classes.begin(), all_state_classes.end()};
    int samples = 12;  ///< per class
    std::uint64_t seed = 1;

    bool is_objective = true;          ///< false for a material that is given its rotation
    bool is_isotropic = false;         ///< true where the material has no preferred direction
    bool is_rest_stress_free = true;   ///< false for a pre-stretched material
    bool has_exact_projection = true;  ///< false where projected_hessian() is positive but not the filtered spectrum
    std::optional<LameParameters<double>> small_strain{};  ///< the linear elasticity it becomes at F = I

    /// Allowed round-off, in epsilon of the scalar: a sum of 81 products (projection) with a factor of safety.
    double round_off = 1000;
};

namespace detail {

/// Any material over Scalar behind four function pointers, so that the suite is compiled once and not per material.
template <RealScalar Scalar>
struct MaterialUnderTest {
    using Gradient = const Matrix3<Scalar>&;

    const void* material;
    Scalar (*energy_density_of)(const void*, Gradient);
    Matrix3<Scalar> (*first_piola_of)(const void*, Gradient);
    Matrix9<Scalar> (*hessian_of)(const void*, Gradient);
    Matrix9<Scalar> (*projected_hessian_of)(const void*, Gradient, PsdFilter);

    template <HyperelasticMaterial M>
    static MaterialUnderTest of(const M& m) {
        return {&m, [](const void* p, Gradient F) { return static_cast<const M*>(p)->energy_density(F); },
                [](const void* p, Gradient F) { return static_cast<const M*>(p)->first_piola(F); },
                [](const void* p, Gradient F) { return static_cast<const M*>(p)->hessian(F); },
                [](const void* p, Gradient F, PsdFilter filter) {
                    return softtissue::projected_hessian(*static_cast<const M*>(p), F, filter);
                }};
    }

    Scalar energy_density(Gradient F) const { return energy_density_of(material, F); }
    Matrix3<Scalar> first_piola(Gradient F) const { return first_piola_of(material, F); }
    Matrix9<Scalar> hessian(Gradient F) const { return hessian_of(material, F); }
    Matrix9<Scalar> projected_hessian(Gradient F, PsdFilter filter) const {
        return projected_hessian_of(material, F, filter);
    }
};

/// Measures the laws of a material at one state after the other.
template <RealScalar Scalar>
class MaterialLawSuite {
public:
    MaterialLawSuite(const MaterialUnderTest<Scalar>& material, const MaterialLawOptions& options)
        : material_(material),
          options_(options),
          random_(options.seed),
          tolerance_(options.round_off * double(std::numeric_limits<Scalar>::epsilon())) {}

    LawReport report() {
        for (const StateClass state_class : options_.states) {
            for (int sample = 0; sample < options_.samples; ++sample) {
                check_state(random_state<Scalar>(state_class, random_), name_of(state_class));
            }
        }
        check_rest();
        return std::move(report_);
    }

private:
    MaterialUnderTest<Scalar> material_;
    MaterialLawOptions options_;
    RandomGenerator random_;
    double tolerance_;
    LawReport report_;

    void check_state(const Matrix3<Scalar>& F, std::string_view state_name) {
        const std::string where = description(F, state_name);
        const Scalar psi = material_.energy_density(F);
        const Matrix3<Scalar> P = material_.first_piola(F);
        const Matrix9<Scalar> H = material_.hessian(F);
        const bool is_finite = std::isfinite(psi) && P.allFinite() && H.allFinite();
        report_.at_least("finite", is_finite ? 1 : 0, 1, where);
        if (!is_finite) {
            return;
        }
        check_rates(F, P, H, where);
        report_.at_most("hessian symmetry", relative(size(H - H.transpose()), size(H)), tolerance_, where);
        check_symmetries(F, psi, P, H, where);
        for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
            check_projection(F, H, filter, where);
        }
    }

    void check_rates(const Matrix3<Scalar>& F, const Matrix3<Scalar>& P, const Matrix9<Scalar>& H,
                     const std::string& where) {
        const Matrix3<Scalar> D = random_unit<Matrix3<Scalar>>(random_);
        const auto energy = [&](Scalar h) { return material_.energy_density(F + h * D); };
        const auto stress = [&](Scalar h) { return vec<Scalar>(material_.first_piola(F + h * D)); };
        const Scalar energy_slope = P.cwiseProduct(D).sum();
        const Vector9<Scalar> stress_slope = H * vec<Scalar>(D);
        record_rate("stress rate", taylor_rate(energy, energy_slope), where);
        record_rate("hessian rate", taylor_rate(stress, stress_slope), where);
    }

    void record_rate(std::string_view law, const TaylorRate& rate, const std::string& where) {
        report_.at_least(law, rate.is_exact ? 2 : rate.order, 1.9, where);
    }

    void check_symmetries(const Matrix3<Scalar>& F, Scalar psi, const Matrix3<Scalar>& P, const Matrix9<Scalar>& H,
                          const std::string& where) {
        const Matrix3<Scalar> R = random_rotation<Scalar>(random_);
        const double stress_scale = size(H) * size(F);
        const double energy_scale = std::abs(double(psi)) + stress_scale * size(F);
        if (options_.is_objective) {
            const Matrix3<Scalar> RF = R * F;
            const double energy_error = std::abs(double(material_.energy_density(RF) - psi));
            const double stress_error = size(material_.first_piola(RF) - R * P);
            report_.at_most("objective energy", relative(energy_error, energy_scale), tolerance_, where);
            report_.at_most("objective stress", relative(stress_error, stress_scale), tolerance_, where);
        }
        if (options_.is_isotropic) {
            const double error = std::abs(double(material_.energy_density(F * R) - psi));
            report_.at_most("isotropic energy", relative(error, energy_scale), tolerance_, where);
        }
    }

    void check_projection(const Matrix3<Scalar>& F, const Matrix9<Scalar>& H, PsdFilter filter,
                          const std::string& where) {
        const Matrix9<Scalar> projected = material_.projected_hessian(F, filter);
        const double scale = size(H);
        report_.at_least("projection positive", relative(smallest_eigenvalue(projected), scale), -tolerance_, where);
        if (options_.has_exact_projection) {
            const double error = size(projected - filtered(H, filter));
            report_.at_most("projection spectrum", relative(error, scale), tolerance_, where);
        }
        // Eigenvalues that are 0 up to round-off count as 0: filtering nine of them moves H by 54 times as much.
        if (relative(smallest_eigenvalue(H), scale) >= -tolerance_ / 100) {
            report_.at_most("projection unchanged", relative(size(projected - filtered(H, PsdFilter::none)), scale),
                            tolerance_, where);
        }
    }

    void check_rest() {
        const Matrix3<Scalar> I = Matrix3<Scalar>::Identity();
        const Matrix9<Scalar> H = material_.hessian(I);
        if (options_.is_rest_stress_free) {
            report_.at_most("rest stress", relative(size(material_.first_piola(I)), size(H)), tolerance_, "I");
        }
        if (options_.small_strain) {
            const Matrix9<Scalar> expected = linear_elasticity(*options_.small_strain);
            report_.at_most("small strain", relative(size(H - expected), size(expected)), tolerance_, "I");
        }
    }

    /// d P / d F of linear elasticity: lambda tr(eps) I + 2 mu eps.
    static Matrix9<Scalar> linear_elasticity(const LameParameters<double>& lame) {
        Matrix9<Scalar> H;
        for (int k = 0; k < 9; ++k) {
            const Matrix3<Scalar> D = unvec<Scalar>(Vector9<Scalar>::Unit(k));
            const Matrix3<Scalar> stress =
                Scalar(lame.mu) * (D + D.transpose()) + Scalar(lame.lambda) * D.trace() * Matrix3<Scalar>::Identity();
            H.col(k) = vec<Scalar>(stress);
        }
        return H;
    }

    static double smallest_eigenvalue(const Matrix9<Scalar>& H) {
        return H.allFinite() ? double(symmetric_eigen(H).values.minCoeff()) : std::numeric_limits<double>::quiet_NaN();
    }

    /// Sum of absolute values: unlike a sum of squares it does not overflow, unlike a maximum it does not lose a NaN.
    template <class Derived>
    static double size(const Eigen::MatrixBase<Derived>& matrix) {
        return double(matrix.template lpNorm<1>());
    }

    /// error / scale; an error without a scale (both 0) is none.
    static double relative(double error, double scale) { return error == 0 ? 0 : error / scale; }

    static std::string description(const Matrix3<Scalar>& F, std::string_view state_name) {
        std::ostringstream text;
        text.precision(std::numeric_limits<Scalar>::max_digits10);
        const Eigen::IOFormat one_line(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", "; ", "", "", "[", "]");
        text << state_name << " F = " << F.format(one_line);
        return text.str();
    }
};

}  // namespace detail

/// Checks every law that the options claim, on states of each class they name.
template <HyperelasticMaterial M>
LawReport check_material_laws(const M& material, const MaterialLawOptions& options = {}) {
    using Scalar = typename M::Scalar;
    static_assert(RealScalar<Scalar>, "check_material_laws needs a material over float or double");
    return detail::MaterialLawSuite<Scalar>(detail::MaterialUnderTest<Scalar>::of(material), options).report();
}

}  // namespace softtissue
