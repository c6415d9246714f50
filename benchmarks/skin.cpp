// SPDX-License-Identifier: MIT
// The skin of a limb of the paper's size, in a pose: energy and gradient of its edges and hinges, and positive semi-definite Hessians
// of the hinges, in closed form and by eigenvalues.

#include "machine_limits.hpp"
#include "posed_limb.hpp"

#include <softtissue/core/executor.hpp>
#include <softtissue/energy/dihedral_chord.hpp>
#include <softtissue/energy/edge_stretch.hpp>
#include <softtissue/energy/hinge_bending.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <benchmark/benchmark.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace {

using namespace softtissue;
using namespace benchmarks;

template <class S>
struct Skin {
    PosedLimb<S> limb;
    FleshParameters<S> parameters;
    EdgeStretch<S> stretch{skin_surface(limb.body), limb.body.mesh.rest_positions, parameters.stretch};
    HingeBending<DihedralChord<S>> bending{skin_surface(limb.body), limb.body.mesh.rest_positions, parameters.bending};
    Matrix3X<S> displacement;
    BlockMatrix<S> hessian;

    Skin() {
        const PosedLimb<double> same;
        displacement = (PoseStarts(same)(10) - same.body.mesh.rest_positions).template cast<S>();
        const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
        std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
        bending.add_neighbours(prescribed, neighbours);
        hessian = BlockMatrix<S>(BlockPattern(std::move(neighbours)));
        bending.bind(prescribed, hessian.pattern());
    }

    static Skin& get() {
        static Skin skin;
        return skin;
    }
};

template <class S, class Term>
void evaluate(benchmark::State& state, Term& term, const char* unit, Index count) {
    const SequentialExecutor executor;
    Matrix3X<S> gradient = Matrix3X<S>::Zero(3, Skin<S>::get().displacement.cols());
    for (auto _ : state) {
        benchmark::DoNotOptimize(term.add_energy_and_gradient(Skin<S>::get().displacement, gradient, executor));
    }
    count_work<S>(state, {.unit = unit, .items = double(count)});
}

template <class S>
void stretching(benchmark::State& state) {
    evaluate<S>(state, Skin<S>::get().stretch, "edges", Skin<S>::get().stretch.num_edges());
}

template <class S>
void bending(benchmark::State& state) {
    evaluate<S>(state, Skin<S>::get().bending, "hinges", Skin<S>::get().bending.num_hinges());
}

template <class S, bool is_convex>
void hinge_hessians(benchmark::State& state) {
    Skin<S>& skin = Skin<S>::get();
    const SequentialExecutor executor;
    for (auto _ : state) {
        skin.hessian.set_zero();
        if constexpr (is_convex) {
            skin.bending.add_convex_hessian(skin.displacement, skin.hessian, executor);
        } else {
            skin.bending.add_hessian(skin.displacement, PsdFilter::clamp, skin.hessian, executor);
        }
    }
    count_work<S>(state, {.unit = "hinges", .items = double(skin.bending.num_hinges())});
}

void in_milliseconds(benchmark::internal::Benchmark* one) {
    one->Unit(benchmark::kMillisecond);
}

#define SOFTTISSUE_HINGES "hinges, positive semi-definite Hessians and assembly/"

BENCHMARK(stretching<float>)->Name("edges, energy and gradient/float")->Apply(in_milliseconds);
BENCHMARK(stretching<double>)->Name("edges, energy and gradient/double")->Apply(in_milliseconds);
BENCHMARK(bending<float>)->Name("hinges, energy and gradient/float")->Apply(in_milliseconds);
BENCHMARK(bending<double>)->Name("hinges, energy and gradient/double")->Apply(in_milliseconds);
BENCHMARK(hinge_hessians<float, true>)->Name(SOFTTISSUE_HINGES "closed form, float")->Apply(in_milliseconds);
BENCHMARK(hinge_hessians<double, true>)->Name(SOFTTISSUE_HINGES "closed form, double")->Apply(in_milliseconds);
BENCHMARK(hinge_hessians<float, false>)->Name(SOFTTISSUE_HINGES "baseline eigenvalues, float")->Apply(in_milliseconds);
BENCHMARK(hinge_hessians<double, false>)
    ->Name(SOFTTISSUE_HINGES "baseline eigenvalues, double")
    ->Apply(in_milliseconds);

}  // namespace
