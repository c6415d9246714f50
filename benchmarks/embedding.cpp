// SPDX-License-Identifier: MIT
// Points that ride on prisms, 134,000 of them, beside the bandwidth of the machine.

#include "machine_limits.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/mesh/prism_layers.hpp>

#include <benchmark/benchmark.h>

namespace {

using namespace softtissue;

constexpr Index num_points = 134000;

/// 53,248 prisms in two layers of a sheet.
template <class S>
CellMesh<Prism6, S> sheet() {
    constexpr Index wide = 65, deep = 209;
    Triangles triangles(3, 2 * (wide - 1) * (deep - 1));
    for (Index j = 0, t = 0; j + 1 < deep; ++j) {
        for (Index i = 0; i + 1 < wide; ++i, t += 2) {
            const auto v = std::int32_t(j * wide + i), above = v + std::int32_t(wide);
            triangles.col(t) << v, v + 1, above;
            triangles.col(t + 1) << v + 1, above + 1, above;
        }
    }
    const PrismLayers layers{wide * deep, 2};
    CellMesh<Prism6, S> mesh;
    mesh.cells = layers.prisms(triangles);
    mesh.rest_positions.resize(3, layers.num_vertices());
    for (Index c = 0; c < layers.num_columns; ++c) {
        for (Index level = 0; level < 3; ++level) {
            mesh.rest_positions.col(layers.vertex(c, level)) << S(c % wide), S(c / wide), S(level);
        }
    }
    return mesh;
}

/// Points that follow the order of the prisms, or in no order.
template <class S>
const Embedding<S>& embedding(bool is_ordered) {
    const auto make = [](bool ordered) {
        const CellMesh<Prism6, S> mesh = sheet<S>();
        RandomGenerator random(1);
        Matrix3X<S> points(3, num_points);
        for (Index p = 0; p < num_points; ++p) {
            const Index cell = ordered ? p * mesh.num_cells() / num_points : random.index(mesh.num_cells());
            const auto X = mesh.rest_nodes(cell);
            const S a = S(random.uniform(0.1, 0.4)), b = S(random.uniform(0.1, 0.4)), t = S(random.uniform());
            points.col(p) = (1 - t) * (a * X.col(0) + b * X.col(1) + (1 - a - b) * X.col(2)) +
                            t * (a * X.col(3) + b * X.col(4) + (1 - a - b) * X.col(5));
        }
        return Embedding<S>(points, mesh);
    };
    static const Embedding<S> ordered = make(true), shuffled = make(false);
    return is_ordered ? ordered : shuffled;
}

/// Argument: threads.
template <class S, bool is_ordered>
void apply(benchmark::State& state) {
    const Embedding<S>& points = embedding<S>(is_ordered);
    const ThreadExecutor executor(int(state.range(0)));
    const Matrix3X<S> x = sheet<S>().rest_positions;
    Matrix3X<S> out(3, num_points);
    for (auto _ : state) {
        points.apply_into(x, out, executor);
        benchmark::DoNotOptimize(out.data());
        benchmark::ClobberMemory();
    }
    const double per_point = Embedding<S>::width * double(sizeof(std::int32_t) + sizeof(S));
    benchmarks::count_work<S>(state, {.unit = "points",
                                      .items = double(num_points),
                                      .flops = 36.0 * num_points,
                                      .bytes_read = per_point * num_points + double(sizeof(S)) * double(x.size()),
                                      .bytes_written = double(sizeof(S)) * double(out.size()),
                                      .threads = int(state.range(0))});
}

}  // namespace

BENCHMARK(apply<float, true>)
    ->Name("15 embedding of 134,000 points/float")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK(apply<double, true>)
    ->Name("15 embedding of 134,000 points/double")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK(apply<float, false>)
    ->Name("15 embedding of 134,000 points in no order/float")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK(apply<double, false>)
    ->Name("15 embedding of 134,000 points in no order/double")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
