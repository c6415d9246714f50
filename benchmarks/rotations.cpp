// SPDX-License-Identifier: MIT
// Rotations of 2,000 matrices, which stay in the cache, and of 50,000: cold and from those of a fit two degrees away, beside
// Eigen's JacobiSVD.
#include "machine_limits.hpp"

#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/linalg/rotation_fit.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/SVD>

using namespace softtissue;

namespace {

/// F = R (I + S), entries of S normal with deviation 0.12, and the same matrices two degrees further.
template <class S>
struct Matrices {
    Index count;
    Matrix3X<S> F{3, 3 * count};
    Matrix3X<S> turned{3, 3 * count};
    Matrix3X<S> R{3, 3 * count};

    explicit Matrices(const benchmark::State& state) : count(state.range(0)) {
        RandomGenerator random(1);
        for (Index c = 0; c < count; ++c) {
            const Matrix3<S> strain = S(0.12) * random_normal<Matrix3<S>>(random);
            const Matrix3<S> strained =
                random_rotation<S>(random) * (Matrix3<S>::Identity() + (strain + strain.transpose()) / S(2));
            F.template middleCols<3>(3 * c) = strained;
            const Vector3<S> turn = S(0.035) * random_unit<Vector3<S>>(random);
            turned.template middleCols<3>(3 * c) = rotation_matrix_from_rotation_vector<S>(turn) * strained;
        }
    }
};

/// Two steps of Newton's method from a closed form (cold); two, in double three, from a quaternion (warm).
template <class S>
void count_matrices(benchmark::State& state, bool is_warm) {
    const double n = double(state.range(0)), steps = is_warm && sizeof(S) == sizeof(double) ? 3 : 2;
    const double quaternion = is_warm ? 4 : 0;
    benchmarks::count_work<S>(state, {.unit = "matrices",
                                      .items = n,
                                      .flops = n * ((is_warm ? 0 : 200) + 130 * steps),
                                      .bytes_read = n * (9 + quaternion) * sizeof(S),
                                      .bytes_written = n * (9 + quaternion) * sizeof(S)});
}

template <class S>
void eigen_jacobi_svd(benchmark::State& state) {
    Matrices<S> matrices(state);
    for (auto _ : state) {
        for (Index c = 0; c < matrices.count; ++c) {
            const Eigen::JacobiSVD<Matrix3<S>> svd(matrices.F.template middleCols<3>(3 * c),
                                                   Eigen::ComputeFullU | Eigen::ComputeFullV);
            matrices.R.template middleCols<3>(3 * c) = svd.matrixU() * svd.matrixV().transpose();
        }
        benchmark::DoNotOptimize(matrices.R.data());
    }
    count_matrices<S>(state, false);
}

template <class S>
void cold(benchmark::State& state) {
    Matrices<S> matrices(state);
    for (auto _ : state) {
        fit_rotations_into(matrices.F, matrices.R);
        benchmark::DoNotOptimize(matrices.R.data());
    }
    count_matrices<S>(state, false);
}

/// To and fro between the two sets: every start is two degrees away.
template <class S>
void warm(benchmark::State& state) {
    Matrices<S> matrices(state);
    Quaternions<S> q = Quaternions<S>::Constant(matrices.count, 4, S(0.5));
    fit_rotations_into(matrices.turned, q, matrices.R);
    for (auto _ : state) {
        fit_rotations_into(matrices.F, q, matrices.R);
        matrices.F.swap(matrices.turned);
        benchmark::DoNotOptimize(matrices.R.data());
    }
    count_matrices<S>(state, true);
}

}  // namespace

BENCHMARK_TEMPLATE(cold, float)
    ->Name("10 rotation fit/cold, float")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(cold, double)
    ->Name("10 rotation fit/cold, double")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(warm, float)
    ->Name("10 rotation fit/warm, float")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(warm, double)
    ->Name("10 rotation fit/warm, double")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(eigen_jacobi_svd, float)
    ->Name("10 rotation fit/baseline Eigen JacobiSVD, float")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(eigen_jacobi_svd, double)
    ->Name("10 rotation fit/baseline Eigen JacobiSVD, double")
    ->Arg(2000)
    ->Arg(50000)
    ->Unit(benchmark::kMicrosecond);
