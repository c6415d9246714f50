// SPDX-License-Identifier: MIT
// Laws over packs, a cell in each lane, beside the same laws one double at a time; projected Hessians also beside Eigen's
// eigen-decomposition of the same 9x9. States: F = R (I + S), entries of S normal with deviation 0.12; results stay in the cache.
#include "machine_limits.hpp"

#include <softtissue/core/pack.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/packed.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>

#include <new>
#include <vector>

namespace {

using namespace softtissue;

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
template <class S, class States, class Kernel>
void run(benchmark::State& state, const States& F, double flops_a_cell, const Kernel& kernel) {
    using Result = decltype(kernel(F.front()));
    std::vector<Result> results(F.size());
    for (auto iteration : state) {
        for (size_t i = 0; i < F.size(); ++i) {
            ::new (&results[i]) Result(kernel(F[i]));  // in place, as callers take it
        }
        benchmark::DoNotOptimize(results.data());
        benchmark::ClobberMemory();
    }
    benchmarks::count_work<S>(state, {.unit = "cells",
                                      .items = count,
                                      .flops = flops_a_cell * count,
                                      .bytes_read = double(F.size() * sizeof(F[0])),
                                      .bytes_written = double(results.size() * sizeof(results[0]))});
}

template <class S>
inline constexpr YoungPoisson<S> flesh = {S(45e3), S(0.47)};

/// One sample of a law, and its operations a cell: those that the headers state less what energy and stress share, 1,100 for a singular value decomposition (fifteen
/// plane rotations), 1,000 for the Hessian in its frame, 19,000 for a 9x9 eigen-decomposition.
template <class M>
struct Sample;

template <class S>
struct Sample<StableNeoHookean<S>> {
    static constexpr double stress_flops = 75, hessian_flops = 2150;
    static StableNeoHookean<S> law() { return StableNeoHookean<S>::from_textbook_lame(flesh<S>); }
};
template <class S>
struct Sample<Arap<S>> {
    static constexpr double stress_flops = 1200, hessian_flops = 2150;
    static Arap<S> law() { return Arap<S>(); }
};
template <class S>
struct Sample<CorotatedLinear<S>> {
    static constexpr double stress_flops = 130, hessian_flops = 120;
    static CorotatedLinear<S> law() { return CorotatedLinear<S>::from_young_poisson(flesh<S>, Matrix3<S>::Identity()); }
};
template <class S>
struct Sample<CorotatedLinearPolar<S>> {
    static constexpr double stress_flops = 1220, hessian_flops = 2170;
    static CorotatedLinearPolar<S> law() { return CorotatedLinearPolar<S>::from_young_poisson(flesh<S>); }
};
template <class S>
struct Sample<FungOrthotropic<S>> {
    static constexpr double stress_flops = 370, hessian_flops = 20200;
    static FungOrthotropic<S> law() {
        return {{.normal_modulus = S(10e3), .tangential_modulus = S(30e3)}, Matrix3<S>::Identity()};
    }
};

template <class M>
auto packed_sample() {
    const M material = Sample<M>::law();
    return packed_law<natural_lanes<typename M::Scalar>>([&](int) -> const M& { return material; });
}

template <class M>
auto energy_and_stress(const M& material) {
    return [material](const Matrix3<typename M::Scalar>& F) { return energy_and_first_piola(material, F); };
}

template <class M>
auto clamped_hessian(const M& material) {
    return
        [material](const Matrix3<typename M::Scalar>& F) { return projected_hessian(material, F, PsdFilter::clamp); };
}

template <class M>
void plain_stress(benchmark::State& state) {
    run<double>(state, states<double>(), Sample<M>::stress_flops, energy_and_stress(Sample<M>::law()));
}
template <class M>
void packed_stress(benchmark::State& state) {
    using S = typename M::Scalar;
    run<S>(state, packed_states<S>(), Sample<M>::stress_flops, energy_and_stress(packed_sample<M>()));
}
template <class M>
void plain_hessian(benchmark::State& state) {
    run<double>(state, states<double>(), Sample<M>::hessian_flops, clamped_hessian(Sample<M>::law()));
}
template <class M>
void packed_hessian(benchmark::State& state) {
    using S = typename M::Scalar;
    run<S>(state, packed_states<S>(), Sample<M>::hessian_flops, clamped_hessian(packed_sample<M>()));
}

/// Every Hessian is decomposed and rebuilt. Compiled once, not into the loop of every material.
[[gnu::noinline]] Matrix9<double> numerically_clamped(const Matrix9<double>& H) {
    const Eigen::SelfAdjointEigenSolver<Matrix9<double>> eigen(H);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

template <class M>
void numeric_hessian(benchmark::State& state) {
    const M material = Sample<M>::law();
    run<double>(state, states<double>(), Sample<M>::hessian_flops,
                [&](const Matrix3<double>& F) { return numerically_clamped(material.hessian(F)); });
}

}  // namespace

#define SOFTTISSUE_BENCHMARK_STRESS(row, words, Law)                                                 \
    BENCHMARK_TEMPLATE(packed_stress, Law<float>)->Name(row "energy and stress, " words "/float");   \
    BENCHMARK_TEMPLATE(packed_stress, Law<double>)->Name(row "energy and stress, " words "/double"); \
    BENCHMARK_TEMPLATE(plain_stress, Law<double>)                                                    \
        ->Name(row "energy and stress, " words "/baseline one by one in double precision")

#define SOFTTISSUE_BENCHMARK_HESSIAN(row, words, Law)                                                 \
    BENCHMARK_TEMPLATE(packed_hessian, Law<float>)->Name(row "projected Hessian, " words "/float");   \
    BENCHMARK_TEMPLATE(packed_hessian, Law<double>)->Name(row "projected Hessian, " words "/double"); \
    BENCHMARK_TEMPLATE(plain_hessian, Law<double>)                                                    \
        ->Name(row "projected Hessian, " words "/baseline one by one in double precision");           \
    BENCHMARK_TEMPLATE(numeric_hessian, Law<double>)                                                  \
        ->Name(row "projected Hessian, " words "/baseline Eigen 9x9 in double precision")

SOFTTISSUE_BENCHMARK_STRESS("3 ", "stable neo-Hookean", StableNeoHookean);
SOFTTISSUE_BENCHMARK_STRESS("3 ", "as rigid as possible", Arap);
SOFTTISSUE_BENCHMARK_STRESS("3 ", "co-rotated (polar)", CorotatedLinearPolar);
SOFTTISSUE_BENCHMARK_STRESS("", "co-rotated (fixed rotation)", CorotatedLinear);
SOFTTISSUE_BENCHMARK_STRESS("", "Fung-orthotropic", FungOrthotropic);
SOFTTISSUE_BENCHMARK_HESSIAN("4 ", "stable neo-Hookean", StableNeoHookean);
SOFTTISSUE_BENCHMARK_HESSIAN("5 ", "Fung-orthotropic", FungOrthotropic);
SOFTTISSUE_BENCHMARK_HESSIAN("", "as rigid as possible", Arap);
SOFTTISSUE_BENCHMARK_HESSIAN("", "co-rotated (fixed rotation)", CorotatedLinear);
SOFTTISSUE_BENCHMARK_HESSIAN("", "co-rotated (polar)", CorotatedLinearPolar);
