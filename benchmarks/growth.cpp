// SPDX-License-Identifier: MIT
// How time and memory grow from 1,000 to 500,000 prisms, on one thread and on two: a layered sheet, its lowest vertices prescribed.
// Times are by the clock; "B/cell" is the largest memory that the set-up and one iteration need beyond what was there, a prism.
#include "layered_sheet.hpp"
#include "machine_limits.hpp"
#include "random_springs.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/supernodal_cholesky.hpp>

#include <benchmark/benchmark.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace softtissue;
using Sheet = benchmarks::LayeredSheet<float>;

Sheet sheet_of(const benchmark::State& state) {
    return Sheet(Index(std::lround(std::sqrt(double(state.range(0)) / 4))));
}

/// Largest resident memory since the construction, where the system tells; else 0.
class PeakMemory {
public:
    PeakMemory() {
#if defined(__GLIBC__)
        malloc_trim(0);
#endif
        std::ofstream("/proc/self/clear_refs") << "5";
        before_ = kilobytes("VmRSS:");
    }

    double bytes() const {
        return 1024 * std::max(0.0, kilobytes("VmHWM:") - before_);
    }

private:
    static double kilobytes(const std::string& key) {
        std::ifstream status("/proc/self/status");
        for (std::string word; status >> word;) {
            if (word == key) {
                double value = 0;
                status >> value;
                return value;
            }
        }
        return 0;
    }

    double before_ = 0;
};

/// Times `step()`, which is run once before.
template <class Step>
void run(benchmark::State& state, const PeakMemory& memory, int threads, const Step& step) {
    step();
    const double bytes = memory.bytes();
    for (auto _ : state) {
        step();
        benchmark::ClobberMemory();
    }
    if (bytes > 0) {
        state.counters["B/cell"] = bytes / double(state.range(0));
    }
    benchmarks::count_work<float>(state, {.unit = "cells", .items = double(state.range(0)), .threads = threads});
}

/// Arguments of all: prisms, threads.
void assembly(benchmark::State& state) {
    using Material = StableNeoHookean<float>;
    const Sheet sheet = sheet_of(state);
    const ThreadExecutor executor(int(state.range(1)));
    const PeakMemory memory;
    ElasticEnergy<Prism6, UniformField<Material>> elastic(
        sheet.mesh, UniformField<Material>{Material::from_textbook_lame({45e3F, 0.47F})});
    const PrescribedVertices held(sheet.mesh.num_vertices(), sheet.prescribed);
    std::vector<std::vector<std::int32_t>> neighbours{size_t(held.num_free())};
    elastic.add_neighbours(held, neighbours);
    BlockMatrix<float> matrix{BlockPattern(std::move(neighbours))};
    elastic.bind(held, matrix.pattern());
    const Matrix3X<float> d = sheet.displacement();
    run(state, memory, int(state.range(1)), [&] {
        matrix.set_zero();
        elastic.add_hessian(d, PsdFilter::clamp, matrix, executor);
    });
}

void poisson_set_up(benchmark::State& state) {
    const Sheet sheet = sheet_of(state);
    const PeakMemory memory;
    run(state, memory, 1, [&] {
        const PoissonReconstruction<Prism6, float> poisson(
            sheet.mesh, PrescribedVertices(sheet.mesh.num_vertices(), sheet.prescribed));
        benchmark::DoNotOptimize(&poisson);
    });
}

void poisson_frame(benchmark::State& state) {
    const Sheet sheet = sheet_of(state);
    const ThreadExecutor executor(int(state.range(1)));
    const PeakMemory memory;
    PoissonReconstruction<Prism6, float> poisson(sheet.mesh,
                                                 PrescribedVertices(sheet.mesh.num_vertices(), sheet.prescribed));
    Matrix3X<float> targets, x = sheet.mesh.rest_positions;
    poisson.gradients_into(x, targets);
    run(state, memory, int(state.range(1)), [&] { poisson.solve_into(targets, x, executor); });
}

BlockMatrix<double> springs_of(const Sheet& sheet) {
    return benchmarks::random_springs(sheet.mesh.cells,
                                      PrescribedVertices(sheet.mesh.num_vertices(), sheet.prescribed));
}

void newton_system(benchmark::State& state) {
    const BlockMatrix<double> K = springs_of(sheet_of(state));
    const PeakMemory memory;
    SupernodalCholesky<double> cholesky;
    cholesky.analyzePattern(K.matrix());
    const VectorX<double> b = VectorX<double>::LinSpaced(K.matrix().rows(), 1, 2);
    VectorX<double> x;
    run(state, memory, 1, [&] {
        cholesky.factorize(K.matrix());
        x = cholesky.solve(b);
    });
}

/// As many points as prisms, somewhere in them.
void embedding(benchmark::State& state) {
    const Sheet sheet = sheet_of(state);
    const ThreadExecutor executor(int(state.range(1)));
    Matrix3X<float> points(3, sheet.mesh.num_cells());
    RandomGenerator random(2);
    for (Index c = 0; c < points.cols(); ++c) {
        const Eigen::Matrix<float, 3, 6> X = sheet.mesh.gather(sheet.mesh.rest_positions, sheet.mesh.cells.col(c));
        points.col(c) = Prism6::position<float>(X, Vector3<float>(0.5F * float(random.uniform(0, 1)), 0.3F, 0.5F));
    }
    const PeakMemory memory;
    const Embedding<float> embedding(points, sheet.mesh, executor);
    run(state, memory, int(state.range(1)), [&] { embedding.apply_into(sheet.mesh.rest_positions, points, executor); });
}

void sizes(benchmark::internal::Benchmark* one, std::vector<std::int64_t> threads) {
    one->ArgNames({"prisms", "threads"})
        ->ArgsProduct({{1024, 10000, 99856, 498436}, std::move(threads)})
        ->Unit(benchmark::kMillisecond)
        ->Repetitions(3)  // the largest take seconds
        ->UseRealTime();
}
void on_one_thread(benchmark::internal::Benchmark* one) {
    sizes(one, {1});
}
void on_two_threads(benchmark::internal::Benchmark* one) {
    sizes(one, {1, 2});
}

}  // namespace

BENCHMARK(assembly)->Name("growth, element Hessians and assembly/float")->Apply(on_two_threads);
BENCHMARK(poisson_set_up)->Name("growth, Poisson, order and factor/float")->Apply(on_one_thread);
BENCHMARK(poisson_frame)->Name("growth, Poisson, a frame/float")->Apply(on_two_threads);
BENCHMARK(newton_system)->Name("growth, a Newton system, factor and solve/double")->Apply(on_one_thread);
BENCHMARK(embedding)->Name("growth, embedding of as many points/float")->Apply(on_two_threads);
