// SPDX-License-Identifier: MIT
// Energy, forces and stiffness of the body of the paper's size, beside the same by plain elements and triplets.
#include "machine_limits.hpp"
#include "paper_body.hpp"
#include "plain_triplets.hpp"

#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/SparseCore>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
struct Scene {
    using Material = StableNeoHookean<S>;
    CellMesh<Prism6, S> mesh{benchmarks::paper_body().layered.mesh.rest_positions.template cast<S>(),
                             benchmarks::paper_body().layered.mesh.cells};
    PrescribedVertices held{mesh.num_vertices(), benchmarks::paper_body().layered.prescribed};
    Material material = Material::from_textbook_lame({S(45e3), S(0.47)});
    ElasticEnergy<Prism6, UniformField<Material>> elastic{mesh, UniformField<Material>{material}};
    RestOperators<Prism6, S> rest = RestOperators<Prism6, S>::at(mesh, mesh.rest_positions);
    Matrix3X<S> d{3, mesh.num_vertices()};  // smooth, strains up to 0.1

    Scene() {
        for (Index v = 0; v < d.cols(); ++v) {
            for (int k = 0; k < 3; ++k) {
                d(k, v) = S(4e-3) * S(std::sin(20 * double(mesh.rest_positions((k + 1) % 3, v))));
            }
        }
    }
};

/// Reads the rest shapes and positions; `written` numbers leave.
template <class S>
void count_cells(benchmark::State& state, double flops_a_cell, double written) {
    const double cells = double(benchmarks::paper_body().layered.mesh.num_cells());
    const double vertices = double(benchmarks::paper_body().layered.mesh.num_vertices());
    benchmarks::count_work<S>(state, {.unit = "cells",
                                      .items = cells,
                                      .flops = flops_a_cell * cells,
                                      .bytes_read = cells * (19 * sizeof(S) + 24) + 3 * vertices * sizeof(S),
                                      .bytes_written = written * sizeof(S)});
}

/// F, the law's and what it takes to bring them to the nodes; see materials.cpp and elastic_energy.hpp.
constexpr double energy_flops = 108 + 30, gradient_flops = 108 + 60 + 108, hessian_flops = 108 + 2150 + 2 * (486 + 567);

template <class S>
void energy(benchmark::State& state) {
    Scene<S> scene;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scene.elastic.energy(scene.d, SequentialExecutor{}));
    }
    count_cells<S>(state, energy_flops, 0);
}

template <class S>
void gradient(benchmark::State& state) {
    Scene<S> scene;
    auto g = scene.d;
    for (auto _ : state) {
        scene.elastic.add_gradient(scene.d, g, SequentialExecutor{});
        benchmark::DoNotOptimize(g.data());
    }
    count_cells<S>(state, gradient_flops, double(g.size()));
}

template <class S>
void hessian(benchmark::State& state) {
    Scene<S> scene;
    const PrescribedVertices& held = scene.held;
    std::vector<std::vector<std::int32_t>> neighbours{size_t(held.num_free())};
    scene.elastic.add_neighbours(held, neighbours);
    BlockMatrix<S> matrix{BlockPattern(std::move(neighbours))};
    scene.elastic.bind(held, matrix.pattern());
    for (auto _ : state) {
        matrix.set_zero();
        scene.elastic.add_hessian(scene.d, PsdFilter::clamp, matrix, SequentialExecutor{});
        benchmark::DoNotOptimize(matrix.matrix().valuePtr());
    }
    count_cells<S>(state, hessian_flops, double(matrix.matrix().nonZeros()));
}

/// Baselines: one cell after the other with the plain law.
template <class S, class Visit>
void for_each_plain_cell(const Scene<S>& scene, const Visit& visit) {
    const CellMesh<Prism6, S>& mesh = scene.mesh;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<Prism6, S> g = scene.rest.cell_gradients(c);
        const Matrix3<S> F = Matrix3<S>::Identity() + mesh.gather(scene.d, mesh.cells.col(c)) * g.transpose();
        visit(c, F, g, scene.rest.volumes(c));
    }
}

template <class S>
void plain_energy(benchmark::State& state) {
    const Scene<S> scene;
    for (auto _ : state) {
        S sum(0);
        for_each_plain_cell(
            scene, [&](Index, const auto& F, const auto&, auto V) { sum += V * scene.material.energy_density(F); });
        benchmark::DoNotOptimize(sum);
    }
    count_cells<S>(state, energy_flops, 0);
}

template <class S>
void plain_gradient(benchmark::State& state) {
    const Scene<S> scene;
    auto gradient = scene.d;
    for (auto _ : state) {
        for_each_plain_cell(scene, [&](Index c, const auto& F, const auto& g, auto V) {
            const NodePositions<Prism6, S> forces = V * scene.material.first_piola(F) * g;
            for (int a = 0; a < 6; ++a) {
                gradient.col(scene.mesh.cells(a, c)) += forces.col(a);
            }
        });
        benchmark::DoNotOptimize(gradient.data());
    }
    count_cells<S>(state, gradient_flops, double(gradient.size()));
}

template <class S>
void triplet_hessian(benchmark::State& state) {
    const Scene<S> scene;
    const PrescribedVertices& held = scene.held;
    Eigen::SparseMatrix<S> matrix(3 * held.num_free(), 3 * held.num_free());
    std::vector<Eigen::Triplet<S>> triplets;
    for (auto _ : state) {
        triplets.clear();
        for_each_plain_cell(scene, [&](Index c, const auto& F, const auto& g, auto V) {
            benchmarks::append_prism<S>(V * projected_hessian(scene.material, F, PsdFilter::clamp), g, scene.mesh.cells,
                                        c, held, triplets);
        });
        matrix.setFromTriplets(triplets.begin(), triplets.end());
        benchmark::DoNotOptimize(matrix.valuePtr());
    }
    count_cells<S>(state, hessian_flops, double(matrix.nonZeros()));
}

}  // namespace

BENCHMARK_TEMPLATE(energy, float)->Name("elastic energy of a body/float")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(energy, double)->Name("elastic energy of a body/double")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(plain_energy, double)
    ->Name("elastic energy of a body/baseline one by one in double precision")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(gradient, float)->Name("elastic forces of a body/float")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(gradient, double)->Name("elastic forces of a body/double")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(plain_gradient, double)
    ->Name("elastic forces of a body/baseline one by one in double precision")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(hessian, float)
    ->Name("6 element Hessians and assembly, a body/float")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(hessian, double)
    ->Name("6 element Hessians and assembly, a body/double")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(triplet_hessian, double)
    ->Name("6 element Hessians and assembly, a body/baseline plain elements and triplets in double precision")
    ->Unit(benchmark::kMillisecond);
