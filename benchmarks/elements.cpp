// SPDX-License-Identifier: MIT
// Element kernels, in cells or points per second.
#include "machine_limits.hpp"

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <vector>

using namespace softtissue;

namespace {

template <class Scalar>
NodePositions<Tet4, Scalar> unit_cell(Tet4) {
    NodePositions<Tet4, Scalar> X;
    X << 0, 1, 0, 0,  //
        0, 0, 1, 0,   //
        0, 0, 0, 1;
    return X;
}

template <class Scalar>
NodePositions<Prism6, Scalar> unit_cell(Prism6) {
    NodePositions<Prism6, Scalar> X;
    X << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,   //
        0, 0, 0, 1, 1, 1;
    return X;
}

template <class E, class Scalar>
std::vector<NodePositions<E, Scalar>> random_cells() {
    RandomGenerator random(1);
    std::vector<NodePositions<E, Scalar>> cells(1000);
    for (NodePositions<E, Scalar>& X : cells) {
        X = unit_cell<Scalar>(E{}) + Scalar(0.05) * random_normal<NodePositions<E, Scalar>>(random);
    }
    return cells;
}

template <class E, class Scalar, class Kernel>
void run(benchmark::State& state, const char* unit, const Kernel& kernel) {
    const std::vector<NodePositions<E, Scalar>> cells = random_cells<E, Scalar>();
    for (auto _ : state) {
        for (const NodePositions<E, Scalar>& X : cells) {
            benchmark::DoNotOptimize(kernel(X));
        }
        benchmark::ClobberMemory();
    }
    benchmarks::count_work<Scalar>(state, {.unit = unit, .items = double(cells.size())});
}

template <class E, class Scalar>
void rest_volume(benchmark::State& state) {
    run<E, Scalar>(state, "cells", [](const auto& X) { return E::rest_volume(X); });
}

template <class E, class Scalar>
void smallest_jacobian_bound(benchmark::State& state) {
    run<E, Scalar>(state, "cells", [](const auto& X) { return E::smallest_jacobian_bound(X); });
}

template <class E, class Scalar>
void gradient_operator(benchmark::State& state) {
    run<E, Scalar>(state, "cells", [](const auto& X) { return E::gradient_operator(X); });
}

template <class E, class Scalar>
void natural_coordinates(benchmark::State& state) {
    run<E, Scalar>(state, "points", [](const auto& X) {
        const Vector3<Scalar> p(Scalar(0.3), Scalar(0.25), Scalar(0.2));
        return E::natural_coordinates(X, p);
    });
}

/// The baseline: Newton in three unknowns from the middle, ten steps.
template <class Scalar>
void naive_natural_coordinates(benchmark::State& state) {
    run<Prism6, Scalar>(state, "points", [](const auto& X) {
        const Vector3<Scalar> p(Scalar(0.3), Scalar(0.25), Scalar(0.2));
        Vector3<Scalar> xi(Scalar(1) / 3, Scalar(1) / 3, 0);
        for (int step = 0; step < 10; ++step) {
            const Vector3<Scalar> residual = p - Prism6::position(X, xi);
            const NodePositions<Prism6, Scalar> g = Prism6::shape_gradients(X, xi);
            // Rows of the inverse of dX/dxi: gradients of lambda_1, lambda_2, zeta.
            xi += Vector3<Scalar>((g.col(1) + g.col(4)).dot(residual), (g.col(2) + g.col(5)).dot(residual),
                                  (g.col(3) + g.col(4) + g.col(5) - g.col(0) - g.col(1) - g.col(2)).dot(residual));
        }
        return xi;
    });
}

BENCHMARK_TEMPLATE(rest_volume, Tet4, double)->Name("rest volume of a tet/double");
BENCHMARK_TEMPLATE(rest_volume, Prism6, double)->Name("rest volume of a prism/double");
BENCHMARK_TEMPLATE(smallest_jacobian_bound, Tet4, double)->Name("bound of the Jacobian of a tet/double");
BENCHMARK_TEMPLATE(smallest_jacobian_bound, Prism6, double)->Name("bound of the Jacobian of a prism/double");
BENCHMARK_TEMPLATE(gradient_operator, Tet4, double)->Name("gradient operator of a tet/double");
BENCHMARK_TEMPLATE(gradient_operator, Prism6, double)->Name("gradient operator of a prism/double");
BENCHMARK_TEMPLATE(natural_coordinates, Tet4, double)->Name("natural coordinates of a tet/double");
BENCHMARK_TEMPLATE(natural_coordinates, Prism6, double)->Name("natural coordinates of a prism/double");
BENCHMARK_TEMPLATE(gradient_operator, Prism6, float)->Name("gradient operator of a prism/float");
BENCHMARK_TEMPLATE(naive_natural_coordinates, double)
    ->Name("natural coordinates of a prism/baseline ten steps of Newton in three unknowns, double");

}  // namespace
