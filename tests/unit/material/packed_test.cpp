// SPDX-License-Identifier: MIT
#include <softtissue/material/packed.hpp>

#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/packed_material.hpp>

#include <doctest/doctest.h>

#include <cstdint>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// Without `packed`: |F|^2, in closed form.
template <class S>
struct Quadratic {
    using Scalar = S;
    S stiffness;
    S energy_density(const Matrix3<S>& F) const { return stiffness * F.squaredNorm(); }
    Matrix3<S> first_piola(const Matrix3<S>& F) const { return S(2) * stiffness * F; }
    Matrix9<S> hessian(const Matrix3<S>&) const { return S(2) * stiffness * Matrix9<S>::Identity(); }
};

static_assert(PackableMaterial<Arap<float>, 4> && PackableMaterial<CorotatedLinear<double>, 2>);
static_assert(PackableMaterial<CorotatedLinearPolar<float>, 4> && PackableMaterial<FungOrthotropic<double>, 3>);
static_assert(PackableMaterial<StableNeoHookean<double>, 8> && !PackableMaterial<Quadratic<double>, 2>);
static_assert(HasProjectedHessian<StableNeoHookean<Pack<double, 2>>> && HasProjectedHessian<Arap<Pack<float, 4>>>);
static_assert(HasProjectedHessian<FungOrthotropic<Pack<double, 2>>>);

/// Both sides are rounded in some hundred operations; where singular values nearly cancel, a rotation's derivative, up to
/// 20 times the law's own stiffness in these states, multiplies the rounding of F.
template <class S>
constexpr double tolerance = 3000 * double(std::numeric_limits<S>::epsilon());

template <class S>
constexpr YoungPoisson<S> constants(int k) {
    return {S(1e4 * (1 + k % 3)), S(0.4)};
}

template <class S>
Matrix3<S> rotation(int k) {
    RandomGenerator random(std::uint64_t(k % 5));
    return random_rotation<S>(random);
}

template <class S>
inline constexpr int width = natural_lanes<S>;

}  // namespace

TEST_CASE_TEMPLATE("stable neo-Hookean over packs", S, float, double) {
    check_packed_material<width<S>>([](int k) { return StableNeoHookean<S>::from_young_poisson(constants<S>(k)); }, 1e4,
                                    tolerance<S>);
}

TEST_CASE_TEMPLATE("as rigid as possible over packs", S, float, double) {
    check_packed_material<width<S>>([](int k) { return Arap<S>({.stiffness = S(1 + k % 3)}); }, 1, tolerance<S>);
}

TEST_CASE_TEMPLATE("co-rotated linear, with its own rotation and with a given one, over packs", S, float, double) {
    check_packed_material<width<S>>([](int k) { return CorotatedLinearPolar<S>::from_young_poisson(constants<S>(k)); },
                                    1e4, tolerance<S>);
    check_packed_material<width<S>>(
        [](int k) { return CorotatedLinear<S>::from_young_poisson(constants<S>(k), rotation<S>(k)); }, 1e4,
        tolerance<S>);
}

TEST_CASE_TEMPLATE("Fung-orthotropic over packs", S, float, double) {
    check_packed_material<width<S>>(
        [](int k) {
            return FungOrthotropic<S>({.normal_modulus = S(1e4 * (1 + k % 3)), .tangential_modulus = S(3e4)},
                                      rotation<S>(k));
        },
        1e4, tolerance<S>);
}

TEST_CASE_TEMPLATE("a law that knows nothing of packs is evaluated lane by lane", S, float, double) {
    constexpr int N = 4;
    const auto law = [](int i) { return Quadratic<S>{S(i + 1)}; };
    const auto laws = packed_law<N>(law);
    static_assert(HyperelasticMaterial<std::remove_cvref_t<decltype(laws)>>);
    RandomGenerator random(2);
    std::vector<Matrix3<S>> states;
    for (int i = 0; i < N; ++i) {
        states.push_back(random_normal<Matrix3<S>>(random));
    }
    const Matrix3<Pack<S, N>> F = packed_matrix<N>([&](int i) { return states[size_t(i)]; });
    const Pack<S, N> psi = laws.energy_density(F);
    const Matrix3<Pack<S, N>> P = laws.first_piola(F);
    const Matrix9<Pack<S, N>> H = laws.hessian(F), projected = projected_hessian(laws, F, PsdFilter::clamp);
    for (int i = 0; i < N; ++i) {
        CHECK(psi[i] == law(i).energy_density(states[size_t(i)]));
        CHECK(lane(P, i) == law(i).first_piola(states[size_t(i)]));
        CHECK(lane(H, i) == law(i).hessian(states[size_t(i)]));
        CHECK(lane(projected, i) == law(i).hessian(states[size_t(i)]));
    }
    // and a packable one all at once
    static_assert(std::same_as<decltype(packed_law<N>([](int) { return Arap<S>(); })), Arap<Pack<S, N>>>);
}
