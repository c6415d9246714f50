// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisations and solves on a layered limb of the paper's size: the Poisson system with three right-hand
// sides, a frame of it, and a Newton system in 3x3 blocks, each beside Eigen's and, where it is there, CHOLMOD's. CHOLMOD is at
// its best with OMP_THREAD_LIMIT=1 and a BLAS that knows the processor (OpenBLAS: OPENBLAS_CORETYPE).

#include "layered_limb.hpp"
#include "machine_limits.hpp"
#include "random_springs.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/cholesky_factor.hpp>
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <Eigen/SparseCholesky>

#include <benchmark/benchmark.h>

#ifdef SOFTTISSUE_HAS_CHOLMOD
#include "tuned_cholmod.hpp"
#endif

#include <utility>
#include <vector>

namespace {

using namespace softtissue;
using namespace benchmarks;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// 80,256 unknowns: springs of random 3x3 stiffness between all vertices that share a cell.
const SparseMatrix& flesh_matrix() {
    static const BlockMatrix<double> matrix =
        benchmarks::random_springs(limb().mesh.cells, PrescribedVertices(limb().mesh.num_vertices(), limb().bone));
    return matrix.matrix();
}

/// What each iteration of Newton's method pays: numbers change, the pattern stays.
template <class Cholesky, class Scalar = double>
void newton_system(benchmark::State& state) {
    const Eigen::SparseMatrix<Scalar> A = flesh_matrix().cast<Scalar>();
    Cholesky cholesky;
    cholesky.analyzePattern(A);
    const VectorX<Scalar> b = VectorX<Scalar>::LinSpaced(A.rows(), Scalar(1), Scalar(2));
    VectorX<Scalar> x;
    for (auto _ : state) {
        cholesky.factorize(A);
        x = cholesky.solve(b);
        benchmark::DoNotOptimize(x.data());
    }
    state.counters["unknowns"] = double(A.rows());
    state.counters["residual"] = double((A * x - b).norm() / b.norm());
}

template <class Cholesky>
void analyze_flesh(benchmark::State& state) {
    Cholesky cholesky;
    for (auto _ : state) {
        cholesky.analyzePattern(flesh_matrix());
    }
}

template <class Scalar>
void solve_poisson(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const CholeskyFactor<Scalar> factor(limb_poisson().matrix, "benchmark");
    typename CholeskyFactor<Scalar>::RightHandSides y(4, factor.num_places());
    const typename CholeskyFactor<Scalar>::RightHandSides b = CholeskyFactor<Scalar>::RightHandSides::Ones(4, y.cols());
    for (auto _ : state) {
        y = b;
        factor.solve_in_place(y, executor);
        benchmark::DoNotOptimize(y.data());
    }
    const double bytes = double(factor.num_bytes());
    count_work<Scalar>(state, {.unit = "unknowns",
                               .items = double(factor.size()),
                               .flops = 16.0 * double(factor.num_entries()),
                               .bytes_read = 2 * bytes,
                               .working_set = bytes + double(sizeof(Scalar)) * double(y.size()),
                               .threads = int(state.range(0))});
}

template <class Cholesky>
void solve_poisson_with(benchmark::State& state) {
    Cholesky cholesky;
    cholesky.analyzePattern(limb_poisson().matrix);
    cholesky.factorize(limb_poisson().matrix);
    const MatrixX<double> b = MatrixX<double>::Ones(limb_poisson().matrix.rows(), 3);
    MatrixX<double> x(b.rows(), 3);
    for (auto _ : state) {
        x = cholesky.solve(b);
        benchmark::DoNotOptimize(x.data());
    }
}

/// A frame: targets to positions. Argument: threads.
template <class Scalar>
void poisson_frame(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const CellMesh<Prism6, Scalar> mesh = limb().mesh_of<Scalar>();
    PoissonReconstruction<Prism6, Scalar> poisson(mesh, PrescribedVertices(mesh.num_vertices(), limb().bone));
    Matrix3X<Scalar> targets, x = mesh.rest_positions;
    poisson.gradients_into(x, targets);
    for (auto _ : state) {
        poisson.solve_into(targets, x, executor);
        benchmark::DoNotOptimize(x.data());
    }
    const double arrays = double(sizeof(Scalar)) * double(targets.size() + x.size());
    count_work<Scalar>(state, {.unit = "cells",
                               .items = double(mesh.num_cells()),
                               .bytes_read = double(poisson.bytes_per_solve()) + arrays,
                               .bytes_written = double(sizeof(Scalar)) * double(x.size()),
                               .threads = int(state.range(0))});
}

/// The same by sparse matrices of Eigen: a product with G^T W and a solve.
void poisson_frame_of_eigen(benchmark::State& state) {
    const LimbPoisson& poisson = limb_poisson();
    const Eigen::SimplicialLLT<SparseMatrix> cholesky(poisson.matrix);
    const MatrixX<double> targets = MatrixX<double>::Ones(poisson.gradient_transpose.cols(), 3);
    MatrixX<double> b(poisson.matrix.rows(), 3), x(poisson.matrix.rows(), 3);
    for (auto _ : state) {
        b.noalias() = poisson.gradient_transpose * targets;
        x = cholesky.solve(b);
        benchmark::DoNotOptimize(x.data());
    }
}

#define SOFTTISSUE_POISSON_SOLVE "1 Poisson, two triangular solves, three right-hand sides/"
#define SOFTTISSUE_POISSON_FRAME "2 Poisson, a frame/"
#define SOFTTISSUE_NEWTON_SYSTEM "7 a Newton system, factor and solve/"
#define SOFTTISSUE_ANALYSIS "a Newton system, analysis/"

void in_milliseconds(benchmark::internal::Benchmark* one) {
    one->Unit(benchmark::kMillisecond);
}
/// Beside what may use several threads.
void by_the_clock(benchmark::internal::Benchmark* one) {
    one->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(solve_poisson<float>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "float")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Apply(by_the_clock);
BENCHMARK(solve_poisson<double>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "double")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Apply(by_the_clock);
BENCHMARK(solve_poisson_with<Eigen::SimplicialLLT<SparseMatrix>>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "baseline Eigen SimplicialLLT AMD")
    ->Apply(by_the_clock);
BENCHMARK(poisson_frame<float>)
    ->Name(SOFTTISSUE_POISSON_FRAME "float")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Apply(by_the_clock);
BENCHMARK(poisson_frame<double>)
    ->Name(SOFTTISSUE_POISSON_FRAME "double")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Apply(by_the_clock);
BENCHMARK(poisson_frame_of_eigen)
    ->Name(SOFTTISSUE_POISSON_FRAME "baseline Eigen, a sparse product and SimplicialLLT")
    ->Apply(by_the_clock);
BENCHMARK(newton_system<SupernodalCholesky<float>, float>)
    ->Name(SOFTTISSUE_NEWTON_SYSTEM "supernodal, float")
    ->Apply(in_milliseconds);
BENCHMARK(newton_system<SupernodalCholesky<double>>)
    ->Name(SOFTTISSUE_NEWTON_SYSTEM "supernodal, double")
    ->Apply(in_milliseconds);
BENCHMARK(newton_system<Eigen::SimplicialLLT<SparseMatrix>>)
    ->Name(SOFTTISSUE_NEWTON_SYSTEM "baseline Eigen SimplicialLLT AMD")
    ->Apply(in_milliseconds);
BENCHMARK(analyze_flesh<SupernodalCholesky<double>>)->Name(SOFTTISSUE_ANALYSIS "double")->Apply(in_milliseconds);
BENCHMARK(analyze_flesh<Eigen::SimplicialLLT<SparseMatrix>>)
    ->Name(SOFTTISSUE_ANALYSIS "baseline Eigen SimplicialLLT AMD")
    ->Apply(in_milliseconds);

#ifdef SOFTTISSUE_HAS_CHOLMOD

BENCHMARK(solve_poisson_with<TunedCholmod<CHOLMOD_SIMPLICIAL, CHOLMOD_AMD>>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "baseline CHOLMOD simplicial AMD")
    ->Apply(by_the_clock);
BENCHMARK(solve_poisson_with<TunedCholmod<CHOLMOD_SIMPLICIAL, CHOLMOD_METIS>>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "baseline CHOLMOD simplicial METIS")
    ->Apply(by_the_clock);
BENCHMARK(solve_poisson_with<TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_AMD>>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "baseline CHOLMOD supernodal AMD")
    ->Apply(by_the_clock);
BENCHMARK(solve_poisson_with<TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_METIS>>)
    ->Name(SOFTTISSUE_POISSON_SOLVE "baseline CHOLMOD supernodal METIS")
    ->Apply(by_the_clock);
BENCHMARK(newton_system<TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_AMD>>)
    ->Name(SOFTTISSUE_NEWTON_SYSTEM "baseline CHOLMOD supernodal AMD")
    ->Apply(in_milliseconds);
BENCHMARK(newton_system<TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_METIS>>)
    ->Name(SOFTTISSUE_NEWTON_SYSTEM "baseline CHOLMOD supernodal METIS")
    ->Apply(in_milliseconds);
BENCHMARK(analyze_flesh<TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_AMD>>)
    ->Name(SOFTTISSUE_ANALYSIS "baseline CHOLMOD supernodal AMD")
    ->Apply(in_milliseconds);

#endif

}  // namespace
