// SPDX-License-Identifier: MIT
// Laws over packs, a cell in each lane, beside the same laws one double at a time.
//
// plain: the scalar law over double. numeric_9x9: its Hessian through Eigen's eigen-decomposition over double. packed: the law
// over packs of float or double. States: F = R (I + S), entries of S normal with deviation 0.12; results stay in the cache.
#include <softtissue/core/pack.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/packed.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>

#include <vector>

using namespace softtissue;

namespace {

constexpr int count = 1024;

template <class S>
std::vector<Matrix3<S>> states() {
    RandomGenerator random(1);
    std::vector<Matrix3<S>> result;
    for (int i = 0; i < count; ++i) {
        const Matrix3<S> strain = S(0.12) * random_normal<Matrix3<S>>(random);
        result.push_back(random_rotation<S>(random) * (Matrix3<S>::Identity() + (strain + strain.transpose()) / S(2)));
    }
    return result;
}

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

/// Times `kernel` over all states; the results go to memory.
template <class States, class Kernel>
void run(benchmark::State& state, const States& F, const Kernel& kernel) {
    std::vector<decltype(kernel(F.front()))> results(F.size());
    for (auto iteration : state) {
        for (size_t i = 0; i < F.size(); ++i) {
            results[i] = kernel(F[i]);
        }
        benchmark::DoNotOptimize(results.data());
        benchmark::ClobberMemory();
    }
    state.counters["cells/s"] = benchmark::Counter(double(count), benchmark::Counter::kIsIterationInvariantRate);
}

template <class S>
constexpr YoungPoisson<S> flesh = {S(45e3), S(0.47)};

template <class S>
StableNeoHookean<S> sample(const StableNeoHookean<S>*) {
    return StableNeoHookean<S>::from_textbook_lame(flesh<S>);
}
template <class S>
Arap<S> sample(const Arap<S>*) {
    return Arap<S>();
}
template <class S>
CorotatedLinearPolar<S> sample(const CorotatedLinearPolar<S>*) {
    return CorotatedLinearPolar<S>::from_young_poisson(flesh<S>);
}
template <class S>
FungOrthotropic<S> sample(const FungOrthotropic<S>*) {
    return {{.normal_modulus = S(10e3), .tangential_modulus = S(30e3)}, Matrix3<S>::Identity()};
}

template <class M>
M sample() {
    return sample(static_cast<const M*>(nullptr));
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
