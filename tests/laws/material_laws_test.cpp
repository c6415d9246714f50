// SPDX-License-Identifier: MIT
// Every material of the library, in float and double, obeys the laws it claims; materials with one planted error break
// exactly the law that error is about.
#include <softtissue/core/notation.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/from_energy.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/material_laws.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

constexpr double mu = 2e4;
constexpr double lambda = 7e4;

template <class S>
struct StableNeoHookeanCase {
    static StableNeoHookean<S> material() { return StableNeoHookean<S>({.mu = S(mu), .lambda = S(lambda)}); }
    static MaterialLawOptions options() {
        return {.is_isotropic = true, .small_strain = LameParameters<double>{mu, lambda - mu}};
    }
};

template <class S>
struct ArapCase {
    static Arap<S> material() { return Arap<S>({.stiffness = S(mu)}); }
    static MaterialLawOptions options() {
        return {.is_isotropic = true, .small_strain = LameParameters<double>{mu, 0}};
    }
};

template <class S>
struct CorotatedLinearPolarCase {
    static CorotatedLinearPolar<S> material() { return CorotatedLinearPolar<S>({.mu = S(mu), .lambda = S(lambda)}); }
    static MaterialLawOptions options() {
        return {.is_isotropic = true, .small_strain = LameParameters<double>{mu, lambda}};
    }
};

/// With the identity as the given rotation the law is plain linear elasticity.
template <class S>
struct LinearCase {
    static CorotatedLinear<S> material() { return {{.mu = S(mu), .lambda = S(lambda)}, Matrix3<S>::Identity()}; }
    static MaterialLawOptions options() {
        return {.is_objective = false, .small_strain = LameParameters<double>{mu, lambda}};
    }
};

/// With any other it is stressed at F = I.
template <class S>
struct CorotatedLinearCase {
    static CorotatedLinear<S> material() {
        RandomGenerator random(3);
        return {{.mu = S(mu), .lambda = S(lambda)}, random_rotation<S>(random)};
    }
    static MaterialLawOptions options() { return {.is_objective = false, .is_rest_stress_free = false}; }
};

template <class S>
struct FungOrthotropicCase {
    static FungOrthotropic<S> material() {
        RandomGenerator random(4);
        return {{.normal_modulus = S(mu), .tangential_modulus = S(3 * mu)}, random_rotation<S>(random)};
    }
    static MaterialLawOptions options() { return {}; }
};

/// With equal moduli and all tau = 1 the same law is isotropic, and linear elasticity of (E, nu) at rest.
template <class S>
struct FungIsotropicCase {
    static FungOrthotropic<S> material() {
        return {{.normal_modulus = S(mu), .tangential_modulus = S(mu)}, Matrix3<S>::Identity()};
    }
    static MaterialLawOptions options() {
        return {.is_isotropic = true, .small_strain = lame_parameters<double>({mu, 0.2})};
    }
};

/// What a researcher writes.
struct UserEnergy {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        const S J = F.determinant();
        return S(mu / 2) * (F.squaredNorm() - S(3)) - S(mu) * (J - S(1)) + S(lambda / 2) * (J - S(1)) * (J - S(1));
    }
};

template <class S>
struct UserEnergyCase {
    static FromEnergy<UserEnergy, S> material() { return {}; }
    static MaterialLawOptions options() {
        return {.is_isotropic = true, .small_strain = LameParameters<double>{mu, lambda - mu}};
    }
};

/// What a researcher writes with a barrier, and for which states.
struct LogarithmicEnergy {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        using std::log;
        const S log_J = log(F.determinant());
        return S(mu / 2) * (F.squaredNorm() - S(3)) - S(mu) * log_J + S(lambda / 2) * log_J * log_J;
    }
};

template <class S>
struct LogarithmicEnergyCase {
    static FromEnergy<LogarithmicEnergy, S> material() { return {}; }
    static MaterialLawOptions options() {
        return {.states = {orientation_preserving_state_classes.begin(), orientation_preserving_state_classes.end()},
                .is_isotropic = true,
                .small_strain = LameParameters<double>{mu, lambda}};
    }
};

}  // namespace

TEST_CASE_TEMPLATE("materials obey the laws they claim", Case, StableNeoHookeanCase<float>,
                   StableNeoHookeanCase<double>, ArapCase<float>, ArapCase<double>, CorotatedLinearPolarCase<float>,
                   CorotatedLinearPolarCase<double>, LinearCase<float>, LinearCase<double>, CorotatedLinearCase<float>,
                   CorotatedLinearCase<double>, FungOrthotropicCase<float>, FungOrthotropicCase<double>,
                   FungIsotropicCase<float>, FungIsotropicCase<double>, UserEnergyCase<float>, UserEnergyCase<double>,
                   LogarithmicEnergyCase<float>, LogarithmicEnergyCase<double>) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        MaterialLawOptions options = Case::options();
        options.seed = seed;
        const LawReport report = check_material_laws(Case::material(), options);
        CHECK_MESSAGE(report.all_passed(), report.summary());
        CHECK(report.has("small strain") == options.small_strain.has_value());
        CHECK(report.has("projection unchanged"));
    }
}
