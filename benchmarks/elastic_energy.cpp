// SPDX-License-Identifier: MIT
// Energy, forces and stiffness of a layered sheet of 60,000 prisms, beside the same by plain elements and triplets.
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/SparseCore>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace softtissue;

namespace {

/// Two layers of prisms over a wavy sheet of n x n squares; the lowest vertices are prescribed.
template <class S>
struct Sheet {
    CellMesh<Prism6, S> mesh;
    std::vector<std::int32_t> prescribed;

    explicit Sheet(Index n) {
        const Index per_layer = (n + 1) * (n + 1);
        mesh.rest_positions.resize(3, 3 * per_layer);
        for (Index layer = 0; layer < 3; ++layer) {
            for (Index i = 0; i <= n; ++i) {
                for (Index j = 0; j <= n; ++j) {
                    const double x = double(i) / double(n), y = double(j) / double(n);
                    mesh.rest_positions.col(layer * per_layer + i * (n + 1) + j) << S(x), S(y),
                        S(0.1 * std::sin(6 * x) * std::cos(5 * y) + 0.01 * double(layer));
                }
            }
        }
        mesh.cells.resize(6, 4 * n * n);
        Index cell = 0;
        for (Index layer = 0; layer < 2; ++layer) {
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < n; ++j) {
                    const Index v = layer * per_layer + i * (n + 1) + j;
                    for (const auto& corners :
                         {std::array{v, v + n + 1, v + 1}, std::array{v + 1, v + n + 1, v + n + 2}}) {
                        for (Index k = 0; k < 3; ++k) {
                            mesh.cells(k, cell) = std::int32_t(corners[size_t(k)]);
                            mesh.cells(k + 3, cell) = std::int32_t(corners[size_t(k)] + per_layer);
                        }
                        ++cell;
                    }
                }
            }
        }
        for (Index v = 0; v < per_layer; ++v) {
            prescribed.push_back(std::int32_t(v));
        }
    }

    Matrix3X<S> displacement() const {
        RandomGenerator random(3);
        Matrix3X<S> d(3, mesh.num_vertices());
        for (S& x : d.reshaped()) {
            x = S(3e-4 * random.normal());
        }
        return d;
    }
};

constexpr Index squares = 122;

template <class S>
StableNeoHookean<S> law(const StableNeoHookean<S>*) {
    return StableNeoHookean<S>::from_textbook_lame({S(45e3), S(0.47)});
}
template <class S>
FungOrthotropic<S> law(const FungOrthotropic<S>*) {
    return {{.normal_modulus = S(10e3), .tangential_modulus = S(30e3)}, Matrix3<S>::Identity()};
}

template <class M>
struct Scene {
    using S = typename M::Scalar;
    Sheet<S> sheet{squares};
    M material = law(static_cast<const M*>(nullptr));
    ElasticEnergy<Prism6, UniformField<M>> elastic{sheet.mesh, UniformField<M>{material}};
    Matrix3X<S> d = sheet.displacement();
};

void count_cells(benchmark::State& state) {
    state.counters["cells/s"] =
        benchmark::Counter(4 * squares * squares, benchmark::Counter::kIsIterationInvariantRate);
}

template <class M>
void energy(benchmark::State& state) {
    Scene<M> scene;
    for (auto _ : state) {
        benchmark::DoNotOptimize(scene.elastic.energy(scene.d, SequentialExecutor{}));
    }
    count_cells(state);
}

template <class M>
void gradient(benchmark::State& state) {
    Scene<M> scene;
    auto g = scene.d;
    for (auto _ : state) {
        scene.elastic.add_gradient(scene.d, g, SequentialExecutor{});
        benchmark::DoNotOptimize(g.data());
    }
    count_cells(state);
}

template <class M>
void hessian(benchmark::State& state) {
    Scene<M> scene;
    const PrescribedVertices held(scene.sheet.mesh.num_vertices(), scene.sheet.prescribed);
    std::vector<std::vector<std::int32_t>> neighbours{size_t(held.num_free())};
    scene.elastic.add_neighbours(held, neighbours);
    BlockMatrix<typename M::Scalar> matrix{BlockPattern(std::move(neighbours))};
    scene.elastic.bind(held, matrix.pattern());
    for (auto _ : state) {
        matrix.set_zero();
        scene.elastic.add_hessian(scene.d, PsdFilter::clamp, matrix, SequentialExecutor{});
        benchmark::DoNotOptimize(matrix.matrix().valuePtr());
    }
    count_cells(state);
}

/// Baselines: one cell after the other with the plain law.
template <class M, class Visit>
void for_each_plain_cell(const Scene<M>& scene, const Visit& visit) {
    for (Index c = 0; c < scene.elastic.num_cells(); ++c) {
        visit(c, scene.elastic.deformation_gradient(scene.d, c), scene.elastic.rest().gradients(c),
              scene.elastic.rest().volume(c));
    }
}

template <class M>
void plain_energy(benchmark::State& state) {
    const Scene<M> scene;
    for (auto _ : state) {
        typename M::Scalar sum(0);
        for_each_plain_cell(
            scene, [&](Index, const auto& F, const auto&, auto V) { sum += V * scene.material.energy_density(F); });
        benchmark::DoNotOptimize(sum);
    }
    count_cells(state);
}

template <class M>
void plain_gradient(benchmark::State& state) {
    const Scene<M> scene;
    auto gradient = scene.d;
    for (auto _ : state) {
        for_each_plain_cell(scene, [&](Index c, const auto& F, const auto& g, auto V) {
            const NodePositions<Prism6, typename M::Scalar> forces = V * scene.material.first_piola(F) * g;
            for (int a = 0; a < 6; ++a) {
                gradient.col(scene.sheet.mesh.cells(a, c)) += forces.col(a);
            }
        });
        benchmark::DoNotOptimize(gradient.data());
    }
    count_cells(state);
}

template <class M>
void triplet_hessian(benchmark::State& state) {
    using S = typename M::Scalar;
    const Scene<M> scene;
    const PrescribedVertices held(scene.sheet.mesh.num_vertices(), scene.sheet.prescribed);
    Eigen::SparseMatrix<S> matrix(3 * held.num_free(), 3 * held.num_free());
    std::vector<Eigen::Triplet<S>> triplets;
    for (auto _ : state) {
        triplets.clear();
        for_each_plain_cell(scene, [&](Index c, const auto& F, const auto& g, auto V) {
            const Matrix9<S> H = V * projected_hessian(scene.material, F, PsdFilter::clamp);
            for (int b = 0; b < 6; ++b) {
                const Eigen::Matrix<S, 9, 3> T = g(0, b) * H.template leftCols<3>() +
                                                 g(1, b) * H.template middleCols<3>(3) +
                                                 g(2, b) * H.template rightCols<3>();
                const std::int32_t column = held.free_index(scene.sheet.mesh.cells(b, c));
                for (int a = 0; a < 6 && column >= 0; ++a) {
                    const Matrix3<S> block = g(0, a) * T.template topRows<3>() + g(1, a) * T.template middleRows<3>(3) +
                                             g(2, a) * T.template bottomRows<3>();
                    const std::int32_t row = held.free_index(scene.sheet.mesh.cells(a, c));
                    for (int k = 0; k < 9 && row >= 0; ++k) {
                        triplets.emplace_back(3 * row + k % 3, 3 * column + k / 3, block.data()[k]);
                    }
                }
            }
        });
        matrix.setFromTriplets(triplets.begin(), triplets.end());
        benchmark::DoNotOptimize(matrix.valuePtr());
    }
    count_cells(state);
}

}  // namespace

#define SOFTTISSUE_BENCHMARK_LAW(Law)                                                \
    BENCHMARK_TEMPLATE(plain_energy, Law<double>)->Unit(benchmark::kMillisecond);    \
    BENCHMARK_TEMPLATE(energy, Law<double>)->Unit(benchmark::kMillisecond);          \
    BENCHMARK_TEMPLATE(energy, Law<float>)->Unit(benchmark::kMillisecond);           \
    BENCHMARK_TEMPLATE(plain_gradient, Law<double>)->Unit(benchmark::kMillisecond);  \
    BENCHMARK_TEMPLATE(gradient, Law<double>)->Unit(benchmark::kMillisecond);        \
    BENCHMARK_TEMPLATE(gradient, Law<float>)->Unit(benchmark::kMillisecond);         \
    BENCHMARK_TEMPLATE(triplet_hessian, Law<double>)->Unit(benchmark::kMillisecond); \
    BENCHMARK_TEMPLATE(hessian, Law<double>)->Unit(benchmark::kMillisecond);         \
    BENCHMARK_TEMPLATE(hessian, Law<float>)->Unit(benchmark::kMillisecond)

SOFTTISSUE_BENCHMARK_LAW(StableNeoHookean);
#ifdef WITH_FUNG
SOFTTISSUE_BENCHMARK_LAW(FungOrthotropic);
#endif
