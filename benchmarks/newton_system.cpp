// SPDX-License-Identifier: MIT
// One linear system of Newton's method: the clamped Hessian of stable neo-Hookean flesh, nu = 0.47, in a limb of the paper's size,
// posed by Gradient Skinning (79,488 unknowns). Conjugate gradients between Gauss-Seidel sweeps to the accuracy that Newton needs
// and beyond, beside CHOLMOD and our own factorisation. "missing" is the share of the exact step's decrease that a step lacks.

#include "machine_limits.hpp"
#include "posed_limb.hpp"

#include <softtissue/core/executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/sparse/block_gauss_seidel.hpp>
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <benchmark/benchmark.h>

#ifdef SOFTTISSUE_HAS_CHOLMOD
#include "tuned_cholmod.hpp"
#endif

#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace softtissue;
using namespace benchmarks;

constexpr int pose = 10;
const PosedLimb<double>& limb() {
    static const PosedLimb<double> result;
    return result;
}

template <class S>
struct System {
    using Material = StableNeoHookean<S>;

    BlockMatrix<S> H;
    VectorX<S> rhs;

    System() {
        CellMesh<Prism6, S> mesh;
        mesh.cells = limb().body.mesh.cells;
        mesh.rest_positions = limb().body.mesh.rest_positions.template cast<S>();
        std::vector<Material> materials;
        for (const LameParameters<double>& lame : layer_moduli(limb().body, FleshParameters<double>{})) {
            materials.push_back(Material({.mu = S(lame.mu), .lambda = S(lame.lambda)}));
        }
        ElasticEnergy<Prism6, CellField<Material>> elastic(mesh, CellField<Material>(std::move(materials)));
        const SequentialExecutor executor;
        Objective objective(PrescribedVertices(mesh.num_vertices(), limb().body.prescribed), executor, elastic);
        const Matrix3X<S> d = (PoseStarts(limb())(pose) - limb().body.mesh.rest_positions).template cast<S>();
        rhs = -objective.gradient(d);
        H = objective.hessian(d, PsdFilter::clamp);
    }

    static const System& get() {
        static const System system;
        return system;
    }
};

/// Twice the decrease that the exact step promises.
double exact_decrease() {
    static const double result = [] {
        const System<double>& system = System<double>::get();
        return SupernodalCholesky<double>(system.H.matrix()).solve(system.rhs).dot(system.rhs);
    }();
    return result;
}

template <class S>
void count(benchmark::State& state, const VectorX<S>& p) {
    const System<double>& system = System<double>::get();
    const VectorX<double> step = p.template cast<double>();
    state.counters["unknowns"] = double(p.size());
    state.counters["missing"] = 1 - (2 * step.dot(system.rhs) - step.dot(system.H.matrix() * step)) / exact_decrease();
}

/// Bytes of the matrix that a solve reads twice an iteration.
double bytes_of_sweep(const BlockPattern& pattern, double size) {
    return double(pattern.num_blocks() - pattern.num_columns()) / 2 * (9 * size + 4);
}

/// To a tolerance of 10^-decimals; Newton needs one, see quasi_static_options().
template <class S, class Inner, int decimals>
void conjugate_gradients(benchmark::State& state) {
    const System<S>& system = System<S>::get();
    const S tolerance = S(std::pow(10.0, -double(decimals)));
    GaussSeidelCg<S, Inner> solver;
    VectorX<S> p;
    LinearSolveResult result{};
    for (auto _ : state) {
        result = solver.solve(system.H, system.rhs, tolerance, p, SequentialExecutor{});
        benchmark::DoNotOptimize(p.data());
    }
    count(state, p);
    state.counters["iterations"] = result.iterations;
}

/// What an iteration costs besides sums of vectors.
template <class S>
void sweeps(benchmark::State& state) {
    const System<double>& system = System<double>::get();
    BlockGaussSeidel<S> matrix;
    (void)matrix.factorize(system.H);
    VectorX<S> v, scratch, w;
    matrix.enter(system.rhs, 1.0, v);
    for (auto _ : state) {
        matrix.multiply_into(v, scratch, w);
        benchmark::DoNotOptimize(w.data());
    }
    const BlockPattern& pattern = system.H.pattern();
    const double sweep = bytes_of_sweep(pattern, sizeof(S)), vectors = 4.0 * double(pattern.num_columns()) * sizeof(S);
    count_work<S>(state, {.unit = "blocks",
                          .items = double(pattern.num_blocks()),
                          .flops = 36.0 * double(pattern.num_blocks() - pattern.num_columns()) / 2,
                          .bytes_read = 2 * sweep + 4 * vectors,
                          .working_set = sweep + 3 * vectors});
}

template <class S>
void take_over(benchmark::State& state) {
    BlockGaussSeidel<S> matrix;
    for (auto _ : state) {
        benchmark::DoNotOptimize(matrix.factorize(System<double>::get().H));
    }
}

/// Each round factors and solves; the pattern is analysed once.
template <class S, class Solver>
void factorise(benchmark::State& state, Solver& solver, double (*flops_of)(const Solver&)) {
    const System<S>& system = System<S>::get();
    solver.analyzePattern(system.H.matrix());
    VectorX<S> p;
    for (auto _ : state) {
        solver.factorize(system.H.matrix());
        p = solver.solve(system.rhs);
        benchmark::DoNotOptimize(p.data());
    }
    count(state, p);
    count_work<S>(state, {.unit = "factors", .items = 1, .flops = flops_of(solver)});
}

template <class S>
void own_cholesky(benchmark::State& state) {
    using Solver = SupernodalCholesky<S>;
    Solver solver;
    factorise<S, Solver>(state, solver, [](const Solver& cholesky) {
        double flops = 0;
        for (const Front& front : cholesky.analysis()->fronts()) {
            for (Index k = 0; k < front.width; ++k) {
                flops += double(front.height - k) * double(front.height - k);
            }
        }
        return flops;
    });
}

#ifdef SOFTTISSUE_HAS_CHOLMOD
template <int ordering>
void cholmod(benchmark::State& state) {
    using Solver = TunedCholmod<CHOLMOD_SUPERNODAL, ordering>;
    Solver solver;
    factorise<double, Solver>(state, solver, [](const Solver& cholesky) { return cholesky.flops(); });
}

#endif

void in_milliseconds(benchmark::internal::Benchmark* one) {
    one->Unit(benchmark::kMillisecond);
}

#define SOFTTISSUE_FLESH "7 a Newton system of flesh, as accurately as Newton needs/"
#define SOFTTISSUE_CENTS "a Newton system of flesh, tolerance 0.01/"
#define SOFTTISSUE_MILLS "a Newton system of flesh, tolerance 0.001/"
#define SOFTTISSUE_SWEEP "a Newton system of flesh, a product between sweeps/"
#define SOFTTISSUE_SCALE "a Newton system of flesh, taking over the Hessian/"

BENCHMARK(conjugate_gradients<float, float, 1>)->Name(SOFTTISSUE_FLESH "float")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<double, float, 1>)->Name(SOFTTISSUE_FLESH "double")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<float, float, 2>)->Name(SOFTTISSUE_CENTS "float")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<double, float, 2>)->Name(SOFTTISSUE_CENTS "double")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<double, double, 2>)
    ->Name(SOFTTISSUE_CENTS "sweeps in double too, double")
    ->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<float, float, 3>)->Name(SOFTTISSUE_MILLS "float")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<double, float, 3>)->Name(SOFTTISSUE_MILLS "double")->Apply(in_milliseconds);
BENCHMARK(conjugate_gradients<double, double, 3>)
    ->Name(SOFTTISSUE_MILLS "sweeps in double too, double")
    ->Apply(in_milliseconds);
BENCHMARK(own_cholesky<float>)->Name(SOFTTISSUE_FLESH "our factorisation, float")->Apply(in_milliseconds);
BENCHMARK(own_cholesky<double>)->Name(SOFTTISSUE_FLESH "our factorisation, double")->Apply(in_milliseconds);
#ifdef SOFTTISSUE_HAS_CHOLMOD
BENCHMARK(cholmod<CHOLMOD_AMD>)->Name(SOFTTISSUE_FLESH "baseline CHOLMOD AMD")->Apply(in_milliseconds);
BENCHMARK(cholmod<CHOLMOD_METIS>)->Name(SOFTTISSUE_FLESH "baseline CHOLMOD METIS")->Apply(in_milliseconds);
#endif
BENCHMARK(sweeps<float>)->Name(SOFTTISSUE_SWEEP "float")->Apply(in_milliseconds);
BENCHMARK(sweeps<double>)->Name(SOFTTISSUE_SWEEP "double")->Apply(in_milliseconds);
BENCHMARK(take_over<float>)->Name(SOFTTISSUE_SCALE "float")->Apply(in_milliseconds);
BENCHMARK(take_over<double>)->Name(SOFTTISSUE_SCALE "double")->Apply(in_milliseconds);

}  // namespace
