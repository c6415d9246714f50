// SPDX-License-Identifier: MIT
// Laws over packs, a cell in each lane, beside the same laws one double at a time.
//
// plain: the scalar law over double. numeric_9x9: its Hessian through Eigen's eigen-decomposition over double. packed: the law
// over packs of float or double. States: F = R (I + S), entries of S normal with deviation 0.12; results stay in the cache.
#include "material_states.hpp"

#include <softtissue/core/pack.hpp>
#include <softtissue/material/packed.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>

#include <vector>

using namespace benchmarks;

namespace {

/// The same, as many side by side as a register has lanes.
template <class S>
std::vector<Matrix3<Pack<S, natural_lanes<S>>>> packed_states() {
    constexpr int N = natural_lanes<S>;
    const std::vector<Matrix3<S>> plain = states<S>();
    std::vector<Matrix3<Pack<S, N>>> result;
    for (int first = 0; first < count; first += N) {
        result.push_back(packed_matrix<N>([&](int i) -> const Matrix3<S>& { return plain[size_t(first + i)]; }));
    }
    return result;
}

template <class M>
auto packed_sample() {
    const M material = sample<M>();
    return packed_law<natural_lanes<typename M::Scalar>>([&](int) -> const M& { return material; });
}

template <class S>
struct EnergyAndStress {
    S energy;
    Matrix3<S> stress;
};

template <class M>
auto energy_and_stress(const M& material) {
    using S = typename M::Scalar;
    return [material](const Matrix3<S>& F) {
        return EnergyAndStress<S>{material.energy_density(F), material.first_piola(F)};
    };
}

template <class M>
auto clamped_hessian(const M& material) {
    return
        [material](const Matrix3<typename M::Scalar>& F) { return projected_hessian(material, F, PsdFilter::clamp); };
}

template <class M>
void plain_energy_and_stress(benchmark::State& state) {
    run(state, states<double>(), energy_and_stress(sample<M>()));
}
template <class M>
void packed_energy_and_stress(benchmark::State& state) {
    run(state, packed_states<typename M::Scalar>(), energy_and_stress(packed_sample<M>()));
}
template <class M>
void plain_hessian(benchmark::State& state) {
    run(state, states<double>(), clamped_hessian(sample<M>()));
}
template <class M>
void packed_hessian(benchmark::State& state) {
    run(state, packed_states<typename M::Scalar>(), clamped_hessian(packed_sample<M>()));
}
template <class M>
void numeric_9x9_hessian(benchmark::State& state) {
    const M material = sample<M>();
    run(state, states<double>(), [&](const Matrix3<double>& F) -> Matrix9<double> {
        const Eigen::SelfAdjointEigenSolver<Matrix9<double>> eigen(material.hessian(F));
        return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
    });
}

}  // namespace

#define SOFTTISSUE_BENCHMARK_STRESS(Law)                      \
    BENCHMARK_TEMPLATE(plain_energy_and_stress, Law<double>); \
    BENCHMARK_TEMPLATE(packed_energy_and_stress, Law<float>); \
    BENCHMARK_TEMPLATE(packed_energy_and_stress, Law<double>)

SOFTTISSUE_BENCHMARK_STRESS(StableNeoHookean);
SOFTTISSUE_BENCHMARK_STRESS(Arap);
SOFTTISSUE_BENCHMARK_STRESS(CorotatedLinearPolar);

BENCHMARK_TEMPLATE(plain_hessian, StableNeoHookean<double>);
BENCHMARK_TEMPLATE(packed_hessian, StableNeoHookean<float>);
BENCHMARK_TEMPLATE(packed_hessian, StableNeoHookean<double>);
BENCHMARK_TEMPLATE(numeric_9x9_hessian, FungOrthotropic<double>);
BENCHMARK_TEMPLATE(plain_hessian, FungOrthotropic<double>);
BENCHMARK_TEMPLATE(packed_hessian, FungOrthotropic<float>);
BENCHMARK_TEMPLATE(packed_hessian, FungOrthotropic<double>);
