// SPDX-License-Identifier: MIT
// Exponentials of many 3x3 matrices and their derivatives, beside Eigen's (unsupported) matrix exponential.

#include <softtissue/linalg/matrix_exponential.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>
#include <softtissue/linalg/matrix_logarithm.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/LU>

#include <unsupported/Eigen/MatrixFunctions>

namespace {

using namespace softtissue;

/// Matrices with normal entries of standard deviation `spread`.
template <class S>
Matrix9X<S> random_logarithms(Index count, double spread) {
    RandomGenerator random(1);
    return Matrix9X<S>::NullaryExpr(9, count, [&] { return S(spread * random.normal()); });
}

void count_matrices(benchmark::State& state, Index bytes_a_matrix) {
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetBytesProcessed(state.iterations() * state.range(0) * bytes_a_matrix);
}

/// Times `kernel(Q, X)`, which fills X, for matrices of that spread; it moves so many numbers a matrix.
template <class S, class Kernel>
void run(benchmark::State& state, double spread, Index numbers_a_matrix, const Kernel& kernel) {
    const Matrix9X<S> Q = random_logarithms<S>(state.range(0), spread);
    Matrix9X<S> X(9, Q.cols());
    for (auto _ : state) {
        kernel(Q, X);
        benchmark::DoNotOptimize(X.data());
        benchmark::ClobberMemory();
    }
    count_matrices(state, numbers_a_matrix * Index(sizeof(S)));
}

template <class S>
void matrix_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, 18, [](const Matrix9X<S>& Q, Matrix9X<S>& X) { matrix_exponentials_into<S>(Q, X); });
}

/// Norms around 3: some matrices need squarings.
template <class S>
void large_matrix_exponentials(benchmark::State& state) {
    run<S>(state, 1, 18, [](const Matrix9X<S>& Q, Matrix9X<S>& X) { matrix_exponentials_into<S>(Q, X); });
}

template <class S>
void matrix_exponential_pullbacks(benchmark::State& state) {
    run<S>(state, 0.3, 27, [](const Matrix9X<S>& Q, Matrix9X<S>& L) { matrix_exponential_pullbacks_into<S>(Q, Q, L); });
}

template <class S>
void one_by_one_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, 18, [](const Matrix9X<S>& Q, Matrix9X<S>& X) {
        for (Index c = 0; c < Q.cols(); ++c) {
            X.col(c) = vec(matrix_exponential(unvec<S>(Q.col(c))));
        }
    });
}

template <class S>
void eigen_exponentials(benchmark::State& state) {
    run<S>(state, 0.3, 18, [](const Matrix9X<S>& Q, Matrix9X<S>& X) {
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
    count_matrices(state, Index(9 * sizeof(S)));
}

constexpr Index body_size = 50000;

}  // namespace

BENCHMARK(matrix_exponentials<float>)->Arg(1)->Arg(1000)->Arg(body_size);
BENCHMARK(matrix_exponentials<double>)->Arg(1)->Arg(1000)->Arg(body_size);
BENCHMARK(large_matrix_exponentials<float>)->Arg(body_size);
BENCHMARK(large_matrix_exponentials<double>)->Arg(body_size);
BENCHMARK(matrix_exponential_pullbacks<float>)->Arg(body_size);
BENCHMARK(matrix_exponential_pullbacks<double>)->Arg(body_size);
BENCHMARK(one_by_one_exponentials<float>)->Arg(body_size);
BENCHMARK(one_by_one_exponentials<double>)->Arg(body_size);
BENCHMARK(eigen_exponentials<float>)->Arg(body_size);
BENCHMARK(eigen_exponentials<double>)->Arg(body_size);
BENCHMARK(matrix_logarithms<float>)->Arg(1000);
BENCHMARK(matrix_logarithms<double>)->Arg(1000);
