// SPDX-License-Identifier: MIT
// An iteration of Projective Skinning on a layered limb of the paper's size, 53,248 prisms: rotations of all cells, then the
// positions that fit them; beside sparse matrices, JacobiSVD and three triangular solves of Eigen.
#include "layered_limb.hpp"
#include "machine_limits.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/solver/local_global.hpp>

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

#include <benchmark/benchmark.h>

#include <cmath>

using namespace softtissue;
using namespace benchmarks;

namespace {

/// The limb bent by half a radian, vertices off the bone shaken by a fifth of a millimetre, a twentieth of an edge.
template <class S>
Matrix3X<S> bent_limb() {
    Matrix3X<S> x = limb().mesh.rest_positions.cast<S>();
    const S length = x.row(2).maxCoeff();
    for (Index v = 0; v < x.cols(); ++v) {
        const S angle = S(0.5) * x(2, v) / length;
        x(0, v) += S(0.5) * length * angle * angle;
        if (limb().layers.level(v) > 0) {
            for (int k = 0; k < 3; ++k) {
                x(k, v) += S(0.0002) * std::sin(S(7 * v + k));
            }
        }
    }
    return x;
}

/// Iterations in calls of 30, as in Projective Skinning; one of them counts. Argument: threads.
template <class S>
void projective_iteration(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const CellMesh<Prism6, S> mesh = limb().mesh_of<S>();
    PoissonReconstruction<Prism6, S> poisson(mesh, PrescribedVertices(mesh.num_vertices(), limb().bone));
    LocalGlobal<Prism6, S> solver(poisson);
    const Matrix3X<S> start = bent_limb<S>();
    Matrix3X<S> x = start;
    constexpr Index iterations = 30;
    while (state.KeepRunningBatch(iterations)) {
        x = start;
        benchmark::DoNotOptimize(
            solver.solve_into(x, {.max_iterations = int(iterations), .step_tolerance = 0}, executor));
    }
    // gradients in and rotations out and in again, quaternions in and out
    const double cells = double(mesh.num_cells()), number = double(sizeof(S));
    count_work<S>(state, {.unit = "cells",
                          .items = cells,
                          .bytes_read = double(poisson.bytes_per_solve()) + cells * (number * (19 + 9 + 4) + 24),
                          .bytes_written = cells * number * (9 + 4),
                          .threads = int(state.range(0))});
}

template <class S>
void projective_iteration_of_eigen(benchmark::State& state) {
    using RowMajor = Eigen::SparseMatrix<S, Eigen::RowMajor>;
    const RowMajor gradient = limb_poisson().gradient.cast<S>();
    const RowMajor gradient_transpose = limb_poisson().gradient_transpose.cast<S>();
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<S>> cholesky(limb_poisson().matrix.cast<S>());
    const PrescribedVertices prescribed(limb().mesh.num_vertices(), limb().bone);
    const Matrix3X<S> bent = bent_limb<S>();
    MatrixX<S> x(bent.cols(), 3), F(gradient.rows(), 3), R(gradient.rows(), 3);
    for (Index v = 0, next_fixed = prescribed.num_free(); v < bent.cols(); ++v) {
        x.row(prescribed.is_prescribed(v) ? next_fixed++ : prescribed.free_index(v)) = bent.col(v);
    }
    MatrixX<S> b(gradient_transpose.rows(), 3);
    for (auto _ : state) {
        F.noalias() = gradient * x;
        for (Index c = 0; c < F.rows(); c += 3) {
            const Matrix3<S> transposed = F.template middleRows<3>(c);
            const Eigen::JacobiSVD<Matrix3<S>> svd(transposed, Eigen::ComputeFullU | Eigen::ComputeFullV);
            Matrix3<S> rotation = svd.matrixU() * svd.matrixV().transpose();
            if (rotation.determinant() < S(0)) {
                Matrix3<S> U = svd.matrixU();
                U.col(2) = -U.col(2);
                rotation = U * svd.matrixV().transpose();
            }
            R.template middleRows<3>(c) = rotation - transposed;
        }
        b.noalias() = gradient_transpose * R;
        x.topRows(b.rows()) += cholesky.solve(b);
        benchmark::DoNotOptimize(x.data());
    }
}

#define SOFTTISSUE_PROJECTIVE "11 a projective iteration/"

void by_the_clock(benchmark::internal::Benchmark* one) {
    one->Unit(benchmark::kMillisecond)->UseRealTime();
}
void on_threads(benchmark::internal::Benchmark* one) {
    one->ArgName("threads")->Arg(1)->Arg(2)->Apply(by_the_clock);
}

BENCHMARK(projective_iteration<float>)->Name(SOFTTISSUE_PROJECTIVE "float")->Apply(on_threads);
BENCHMARK(projective_iteration<double>)->Name(SOFTTISSUE_PROJECTIVE "double")->Apply(on_threads);
BENCHMARK(projective_iteration_of_eigen<float>)
    ->Name(SOFTTISSUE_PROJECTIVE "baseline Eigen JacobiSVD and three solves, float")
    ->Apply(by_the_clock);
BENCHMARK(projective_iteration_of_eigen<double>)
    ->Name(SOFTTISSUE_PROJECTIVE "baseline Eigen JacobiSVD and three solves, double")
    ->Apply(by_the_clock);

}  // namespace
