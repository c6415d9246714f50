// SPDX-License-Identifier: MIT
// Cells per second of energy density, stress, Hessian and filtered Hessian of every material.
//
// Beside each closed-form projection: the numeric 9x9 eigen-decomposition of the same Hessian ("numeric_9x9"); beside svd3:
// Eigen's JacobiSVD. States: F = R (I + S), entries of S normal with deviation 0.12.
#include "material_states.hpp"

#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/svd3.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <vector>

using namespace benchmarks;

namespace {

template <class M>
void energy_density(benchmark::State& state) {
    const M material = sample<M>();
    run(state, states<typename M::Scalar>(), [&](const auto& F) { return material.energy_density(F); });
}

template <class M>
void first_piola(benchmark::State& state) {
    const M material = sample<M>();
    run(state, states<typename M::Scalar>(), [&](const auto& F) { return material.first_piola(F); });
}

template <class M>
void hessian(benchmark::State& state) {
    const M material = sample<M>();
    run(state, states<typename M::Scalar>(), [&](const auto& F) { return material.hessian(F); });
}

template <class M>
void projected_hessian(benchmark::State& state) {
    const M material = sample<M>();
    run(state, states<typename M::Scalar>(),
        [&](const auto& F) { return material.projected_hessian(F, PsdFilter::clamp); });
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
    const M material = sample<M>();
    run(state, states<typename M::Scalar>(),
        [&](const auto& F) { return numerically_clamped<typename M::Scalar>(material.hessian(F)); });
}

template <class Scalar>
void rotation(benchmark::State& state) {
    run(state, states<Scalar>(), [](const Matrix3<Scalar>& F) { return polar_rotation(F); });
}

template <class Scalar>
void eigen_jacobi_svd_rotation(benchmark::State& state) {
    run(state, states<Scalar>(), [](const Matrix3<Scalar>& F) {
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
