// SPDX-License-Identifier: MIT
// Cells per second of energy density, stress, Hessian and filtered Hessian of every material.
//
// Beside each closed-form projection: the numeric 9x9 eigen-decomposition of the same Hessian ("numeric_9x9"); beside svd3:
// Eigen's JacobiSVD. States: F = R (I + S), entries of S normal with deviation 0.12.
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/svd3.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <vector>

using namespace softtissue;

namespace {

template <class Scalar>
std::vector<Matrix3<Scalar>> states() {
    RandomGenerator random(1);
    std::vector<Matrix3<Scalar>> result;
    for (int i = 0; i < 1024; ++i) {
        const Matrix3<Scalar> S = Scalar(0.12) * random_normal<Matrix3<Scalar>>(random);
        const Matrix3<Scalar> stretch = Matrix3<Scalar>::Identity() + (S + S.transpose()) / Scalar(2);
        result.push_back(random_rotation<Scalar>(random) * stretch);
    }
    return result;
}

/// Times `kernel` over all states, one after the other; the results go to memory.
template <class Scalar, class Kernel>
void run(benchmark::State& state, const Kernel& kernel) {
    const std::vector<Matrix3<Scalar>> F = states<Scalar>();
    std::vector<decltype(kernel(F.front()))> results(F.size());
    for (auto iteration : state) {
        for (size_t i = 0; i < F.size(); ++i) {
            results[i] = kernel(F[i]);
        }
        benchmark::DoNotOptimize(results.data());
        benchmark::ClobberMemory();
    }
    state.counters["cells/s"] =
        benchmark::Counter(double(state.iterations()) * double(F.size()), benchmark::Counter::kIsRate);
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
CorotatedLinear<S> sample(const CorotatedLinear<S>*) {
    return CorotatedLinear<S>::from_young_poisson(flesh<S>, Matrix3<S>::Identity());
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
void energy_density(benchmark::State& state) {
    const M material = sample(static_cast<const M*>(nullptr));
    run<typename M::Scalar>(state, [&](const auto& F) { return material.energy_density(F); });
}

template <class M>
void first_piola(benchmark::State& state) {
    const M material = sample(static_cast<const M*>(nullptr));
    run<typename M::Scalar>(state, [&](const auto& F) { return material.first_piola(F); });
}

template <class M>
void hessian(benchmark::State& state) {
    const M material = sample(static_cast<const M*>(nullptr));
    run<typename M::Scalar>(state, [&](const auto& F) { return material.hessian(F); });
}

template <class M>
void projected_hessian(benchmark::State& state) {
    const M material = sample(static_cast<const M*>(nullptr));
    run<typename M::Scalar>(state, [&](const auto& F) { return material.projected_hessian(F, PsdFilter::clamp); });
}

/// The baseline: every Hessian is decomposed and rebuilt. Compiled once, not into the loop of every material.
template <class Scalar>
[[gnu::noinline]] Matrix9<Scalar> numerically_clamped(const Matrix9<Scalar>& H) {
    const Eigen::SelfAdjointEigenSolver<Matrix9<Scalar>> eigen(H);
    const Vector9<Scalar> clamped = eigen.eigenvalues().cwiseMax(Scalar(0));
    return eigen.eigenvectors() * clamped.asDiagonal() * eigen.eigenvectors().transpose();
}

template <class M>
void numeric_9x9_projected_hessian(benchmark::State& state) {
    const M material = sample(static_cast<const M*>(nullptr));
    run<typename M::Scalar>(state, [&](const auto& F) { return numerically_clamped<typename M::Scalar>(material.hessian(F)); });
}

template <class Scalar>
void rotation(benchmark::State& state) {
    run<Scalar>(state, [](const Matrix3<Scalar>& F) { return polar_rotation(F); });
}

template <class Scalar>
void eigen_jacobi_svd_rotation(benchmark::State& state) {
    run<Scalar>(state, [](const Matrix3<Scalar>& F) {
        const Eigen::JacobiSVD<Matrix3<Scalar>> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
        return Matrix3<Scalar>(svd.matrixU() * svd.matrixV().transpose());
    });
}

}  // namespace

#define SOFTTISSUE_BENCHMARK_MATERIAL(Material)      \
    BENCHMARK_TEMPLATE(energy_density, Material);    \
    BENCHMARK_TEMPLATE(first_piola, Material);       \
    BENCHMARK_TEMPLATE(hessian, Material);           \
    BENCHMARK_TEMPLATE(projected_hessian, Material); \
    BENCHMARK_TEMPLATE(numeric_9x9_projected_hessian, Material)

SOFTTISSUE_BENCHMARK_MATERIAL(StableNeoHookean<double>);
SOFTTISSUE_BENCHMARK_MATERIAL(StableNeoHookean<float>);
SOFTTISSUE_BENCHMARK_MATERIAL(FungOrthotropic<double>);
SOFTTISSUE_BENCHMARK_MATERIAL(FungOrthotropic<float>);
SOFTTISSUE_BENCHMARK_MATERIAL(Arap<double>);
SOFTTISSUE_BENCHMARK_MATERIAL(Arap<float>);
SOFTTISSUE_BENCHMARK_MATERIAL(CorotatedLinear<double>);
SOFTTISSUE_BENCHMARK_MATERIAL(CorotatedLinear<float>);
SOFTTISSUE_BENCHMARK_MATERIAL(CorotatedLinearPolar<double>);
SOFTTISSUE_BENCHMARK_MATERIAL(CorotatedLinearPolar<float>);

BENCHMARK_TEMPLATE(rotation, double);
BENCHMARK_TEMPLATE(eigen_jacobi_svd_rotation, double);
BENCHMARK_TEMPLATE(rotation, float);
BENCHMARK_TEMPLATE(eigen_jacobi_svd_rotation, float);
