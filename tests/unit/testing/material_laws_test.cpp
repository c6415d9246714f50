// SPDX-License-Identifier: MIT
// The law suite notices every kind of mistake, and blames it on the right law.
#include <softtissue/testing/material_laws.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/material/from_energy.hpp>

#include <Eigen/Core>

#include <cmath>
#include <string>

using namespace softtissue;

namespace {

/// The names of the broken laws, separated by commas.
std::string broken_laws(const LawReport& report) {
    std::string names;
    for (const LawResult& result : report.results) {
        if (!result.passed) {
            names += (names.empty() ? "" : ", ") + result.law;
        }
    }
    return names;
}

/// Stress-free at rest; small-strain limit (mu, lambda) = (1, 2).
struct NeoHookean {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        const S J = F.determinant();
        return S(0.5) * F.squaredNorm() - (J - S(1)) + S(1.5) * (J - S(1)) * (J - S(1));
    }
};

struct Prestressed {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        return NeoHookean{}.energy_density(F) + S(0.01) * F.determinant();
    }
};

struct Fibrous {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        const S strain = F.col(0).squaredNorm() - S(1);
        return NeoHookean{}.energy_density(F) + strain * strain;
    }
};

/// Penalises rotations, as linear elasticity without co-rotation does.
struct NotObjective {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        return (F - Eigen::Matrix<S, 3, 3>::Identity()).squaredNorm();
    }
};

struct Barrier {
    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        using std::log;
        const S log_J = log(F.determinant());
        return S(0.5) * F.squaredNorm() - log_J + log_J * log_J;
    }
};

/// A right material; each wrong one below replaces one member.
template <class S>
struct Right {
    using Scalar = S;
    FromEnergy<NeoHookean, S> law{};
    S energy_density(const Matrix3<S>& F) const { return law.energy_density(F); }
    Matrix3<S> first_piola(const Matrix3<S>& F) const { return law.first_piola(F); }
    Matrix9<S> hessian(const Matrix3<S>& F) const { return law.hessian(F); }
};

/// Stress and Hessian off by the same factor; -1 is the wrong sign.
template <class S>
struct ScaledStress : Right<S> {
    S factor;
    explicit ScaledStress(S f) : factor(f) {}
    Matrix3<S> first_piola(const Matrix3<S>& F) const { return factor * this->law.first_piola(F); }
    Matrix9<S> hessian(const Matrix3<S>& F) const { return factor * this->law.hessian(F); }
};

template <class S>
struct ScaledHessian : Right<S> {
    Matrix9<S> hessian(const Matrix3<S>& F) const { return S(1.1) * this->law.hessian(F); }
};

/// The Hessian on row-major vec(F).
template <class S>
struct RowMajorHessian : Right<S> {
    Matrix9<S> hessian(const Matrix3<S>& F) const {
        const Matrix9<S> H = this->law.hessian(F);
        Matrix9<S> result;
        for (int k = 0; k < 9; ++k) {
            for (int l = 0; l < 9; ++l) {
                result(k, l) = H(k / 3 + 3 * (k % 3), l / 3 + 3 * (l % 3));
            }
        }
        return result;
    }
};

template <class S>
struct AsymmetricHessian : Right<S> {
    Matrix9<S> hessian(const Matrix3<S>& F) const {
        Matrix9<S> H = this->law.hessian(F);
        H(0, 4) += S(0.1);
        H(4, 0) -= S(0.1);
        return H;
    }
};

template <class S>
struct Unprojected : Right<S> {
    Matrix9<S> projected_hessian(const Matrix3<S>& F, PsdFilter) const { return this->law.hessian(F); }
};

template <class S>
struct Overprojected : Right<S> {
    Matrix9<S> projected_hessian(const Matrix3<S>& F, PsdFilter filter) const {
        return filtered(this->law.hessian(F), filter) + S(0.01) * Matrix9<S>::Identity();
    }
};

/// Clamps where it should take absolute values: positive, but not what was asked for.
template <class S>
struct AlwaysClamped : Right<S> {
    Matrix9<S> projected_hessian(const Matrix3<S>& F, PsdFilter) const {
        return filtered(this->law.hessian(F), PsdFilter::clamp);
    }
};

}  // namespace

static_assert(HyperelasticMaterial<AsymmetricHessian<double>> && HasProjectedHessian<Unprojected<float>>);

TEST_CASE_TEMPLATE("a right material breaks no law", S, float, double) {
    const LawReport report =
        check_material_laws(Right<S>{}, {.is_isotropic = true, .small_strain = LameParameters<double>{1, 2}});
    CHECK_MESSAGE(report.all_passed(), report.summary());
    CHECK(report.results.size() == 12);
}

TEST_CASE_TEMPLATE("one mistake breaks the law it is about and no other", S, float, double) {
    CHECK(broken_laws(check_material_laws(ScaledStress<S>(S(-1)))) == "stress rate");
    CHECK(broken_laws(check_material_laws(ScaledStress<S>(S(1.1)))) == "stress rate");
    CHECK(broken_laws(check_material_laws(ScaledHessian<S>{})) == "hessian rate");
    CHECK(broken_laws(check_material_laws(RowMajorHessian<S>{})) == "hessian rate");
    CHECK(broken_laws(check_material_laws(AsymmetricHessian<S>{})) == "hessian rate, hessian symmetry");
    CHECK(broken_laws(check_material_laws(FromEnergy<NotObjective, S>{})) == "objective energy, objective stress");
    CHECK(broken_laws(check_material_laws(FromEnergy<Fibrous, S>{}, {.is_isotropic = true})) == "isotropic energy");
    CHECK(broken_laws(check_material_laws(FromEnergy<Prestressed, S>{})) == "rest stress");
    CHECK(broken_laws(check_material_laws(Right<S>{}, {.small_strain = LameParameters<double>{1, 3}})) ==
          "small strain");
    CHECK(broken_laws(check_material_laws(Unprojected<S>{})) == "projection positive, projection spectrum");
    CHECK(broken_laws(check_material_laws(Overprojected<S>{})) == "projection spectrum, projection unchanged");
    CHECK(broken_laws(check_material_laws(AlwaysClamped<S>{})) == "projection spectrum");
    CHECK(broken_laws(check_material_laws(FromEnergy<Barrier, S>{},
                                          {.states = {StateClass::small_strain, StateClass::inverted}})) == "finite");
}

TEST_CASE("a stress that is wrong by 1e-4 is caught in double") {
    CHECK(broken_laws(check_material_laws(ScaledStress<double>(1 + 1e-4))) == "stress rate");
    CHECK(broken_laws(check_material_laws(ScaledStress<double>(1 - 1e-4))) == "stress rate");
}

TEST_CASE("a law that is not claimed is not checked") {
    const auto claims_nothing =
        MaterialLawOptions{.is_objective = false, .is_rest_stress_free = false, .has_exact_projection = false};
    const LawReport report = check_material_laws(FromEnergy<NotObjective>{}, claims_nothing);
    CHECK_MESSAGE(report.all_passed(), report.summary());
    for (const char* law : {"objective energy", "objective stress", "isotropic energy", "rest stress", "small strain",
                            "projection spectrum"}) {
        CHECK_FALSE(report.has(law));
    }
    CHECK(check_material_laws(FromEnergy<Fibrous>{}).all_passed());
    CHECK(check_material_laws(FromEnergy<Prestressed>{}, {.is_rest_stress_free = false}).all_passed());
    CHECK(check_material_laws(AlwaysClamped<double>{}, {.has_exact_projection = false}).all_passed());
}

TEST_CASE("the report names the state that broke a law, in full digits") {
    const LawReport report = check_material_laws(FromEnergy<NotObjective>{});
    const std::string detail = report["objective energy"].detail;
    CHECK(detail.find(" F = [") != std::string::npos);
    CHECK(report.summary().find(detail) != std::string::npos);
}

TEST_CASE("equal seeds give equal reports") {
    CHECK(check_material_laws(Right<float>{}).summary() == check_material_laws(Right<float>{}).summary());
    CHECK(check_material_laws(Right<double>{}, {.seed = 2})["hessian rate"].measured !=
          check_material_laws(Right<double>{}, {.seed = 3})["hessian rate"].measured);
}
