// SPDX-License-Identifier: MIT
// Exponentials of many 3x3 matrices and their derivatives, beside Eigen's (unsupported) matrix exponential.

#include "machine_limits.hpp"

#include <softtissue/linalg/matrix_exponential.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>
#include <softtissue/linalg/matrix_logarithm.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/LU>

#include <unsupported/Eigen/MatrixFunctions>

#include <array>

namespace {

using namespace softtissue;

/// Matrices with normal entries of standard deviation `spread`.
template <class S>
Matrix9X<S> random_logarithms(Index count, double spread) {
    RandomGenerator random(1);
    return Matrix9X<S>::NullaryExpr(9, count, [&] { return S(spread * random.normal()); });
}

/// `flops`: in float and in double, those that the headers state.
template <class S>
void count_matrices(benchmark::State& state, std::array<double, 2> flops, double numbers_read) {
    const double n = double(state.range(0));
    benchmarks::count_work<S>(state, {.unit = "matrices",
                                      .items = n,
                                      .flops = n * flops[sizeof(S) / sizeof(float) - 1],
                                      .bytes_read = n * numbers_read * sizeof(S),
                                      .bytes_written = n * 9 * sizeof(S)});
}

/// Times `kernel(Q, X)`, which fills X, for matrices of that spread.
template <class S, class Kernel>
void run(benchmark::State& state, double spread, std::array<double, 2> flops, const Kernel& kernel) {
    const Matrix9X<S> Q = random_logarithms<S>(state.range(0), spread);
    Matrix9X<S> X(9, Q.cols());
    for (auto _ : state) {
        kernel(Q, X);
        benchmark::DoNotOptimize(X.data());
        benchmark::ClobberMemory();
    }
    count_matrices<S>(state, flops, 9);
}

constexpr std::array<double, 2> value_flops{200, 260};

template <class S>
void matrix_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, value_flops, [](const Matrix9X<S>& Q, Matrix9X<S>& X) { matrix_exponentials_into<S>(Q, X); });
}

/// Norms around 3: some matrices need squarings.
template <class S>
void large_matrix_exponentials(benchmark::State& state) {
    run<S>(state, 1, {}, [](const Matrix9X<S>& Q, Matrix9X<S>& X) { matrix_exponentials_into<S>(Q, X); });
}

template <class S>
void matrix_exponential_pullbacks(benchmark::State& state) {
    run<S>(state, 0.3, {500, 650},
           [](const Matrix9X<S>& Q, Matrix9X<S>& L) { matrix_exponential_pullbacks_into<S>(Q, Q, L); });
}

template <class S>
void one_by_one_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, value_flops, [](const Matrix9X<S>& Q, Matrix9X<S>& X) {
        for (Index c = 0; c < Q.cols(); ++c) {
            X.col(c) = vec(matrix_exponential(unvec<S>(Q.col(c))));
        }
    });
}

template <class S>
void eigen_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, value_flops, [](const Matrix9X<S>& Q, Matrix9X<S>& X) {
        for (Index c = 0; c < Q.cols(); ++c) {
            const Matrix3<S> exponential = unvec<S>(Q.col(c)).exp();
            X.col(c) = vec(exponential);
        }
    });
}

template <class S>
void matrix_logarithms(benchmark::State& state) {
    Matrix9X<S> F = random_logarithms<S>(state.range(0), 0.3);
    matrix_exponentials_into<S>(F, F);
    for (auto _ : state) {
        for (Index c = 0; c < F.cols(); ++c) {
            benchmark::DoNotOptimize(matrix_logarithm<S>(unvec<S>(F.col(c))));
        }
    }
    benchmarks::count_work<S>(state, {.unit = "matrices", .items = double(state.range(0))});
}

constexpr Index body_size = 50000;

}  // namespace

BENCHMARK(matrix_exponentials<float>)->Name("12 matrix exponential/float")->Arg(1)->Arg(1000)->Arg(body_size);
BENCHMARK(matrix_exponentials<double>)->Name("12 matrix exponential/double")->Arg(1)->Arg(1000)->Arg(body_size);
BENCHMARK(one_by_one_exponentials<float>)->Name("12 matrix exponential/one by one, float")->Arg(body_size);
BENCHMARK(one_by_one_exponentials<double>)->Name("12 matrix exponential/one by one, double")->Arg(body_size);
BENCHMARK(eigen_exponentials<float>)->Name("12 matrix exponential/baseline Eigen exp, float")->Arg(body_size);
BENCHMARK(eigen_exponentials<double>)->Name("12 matrix exponential/baseline Eigen exp, double")->Arg(body_size);
BENCHMARK(large_matrix_exponentials<float>)->Name("matrix exponential, norms about 3/float")->Arg(body_size);
BENCHMARK(large_matrix_exponentials<double>)->Name("matrix exponential, norms about 3/double")->Arg(body_size);
BENCHMARK(matrix_exponential_pullbacks<float>)->Name("matrix exponential, pull-back/float")->Arg(body_size);
BENCHMARK(matrix_exponential_pullbacks<double>)->Name("matrix exponential, pull-back/double")->Arg(body_size);
BENCHMARK(matrix_logarithms<float>)->Name("matrix logarithm/float")->Arg(1000);
BENCHMARK(matrix_logarithms<double>)->Name("matrix logarithm/double")->Arg(1000);
