// SPDX-License-Identifier: MIT
#include <softtissue/solver/scalar_metric.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/refusal.hpp>
#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <array>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("the metric is the mean of the blocks over directions; maps turn it", S, float, double) {
    const auto block = solid_block<Prism6, S>({.n = 2, .noise = 0.05});
    using Material = StableNeoHookean<S>;
    ElasticEnergy<Prism6, UniformField<Material>> elastic(
        block.mesh, UniformField<Material>{Material::from_textbook_lame({S(2.5e3), S(0.25)})});
    const std::array<std::int32_t, 3> held{0, 1, 4};
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(block.mesh.num_vertices(), held), executor, elastic);
    const BlockMatrix<S>& K = objective.hessian(Matrix3X<S>::Zero(3, block.mesh.num_vertices()), PsdFilter::none);
    const Index n = objective.prescribed().num_free();
    ScalarMetric<S> metric;
    metric.factorize(K, "K");

    RandomGenerator random(1);
    VectorX<S> r(3 * n), p, product = VectorX<S>::Zero(3 * n);
    for (S& number : r) {
        number = S(random.normal());
    }
    Matrix3X<S> Q(3, 3 * n);
    for (Index v = 0; v < n; ++v) {
        Q.template middleCols<3>(3 * v) = random_rotation<S>(random);
    }
    for (const bool has_maps : {false, true}) {
        if (has_maps) {
            metric.maps() = Q;
        }
        metric.solve_into(r, p);
        // S Q^T p = Q^T r
        const auto unmapped = [&](const VectorX<S>& x, Index v) -> Vector3<S> {
            const Vector3<S> part = x.template segment<3>(3 * v);
            return has_maps ? Vector3<S>(Q.template middleCols<3>(3 * v).transpose() * part) : part;
        };
        S error(0), size(0);
        for (Index j = 0; j < n; ++j) {
            Vector3<S> sum = Vector3<S>::Zero();
            for (std::int32_t rank = 0; rank < std::int32_t(K.pattern().rows(j).size()); ++rank) {
                sum += K.block(j, rank).trace() / S(3) * unmapped(p, K.pattern().rows(j)[size_t(rank)]);
            }
            error = std::max(error, (sum - unmapped(r, j)).norm());
            size = std::max(size, sum.norm());
        }
        CHECK(error < S(1e3) * std::numeric_limits<S>::epsilon() * size);
    }
}

TEST_CASE("a stiffness without support is refused") {
    std::vector<std::vector<std::int32_t>> neighbours(2);
    neighbours[0] = {1};
    neighbours[1] = {0};
    BlockMatrix<double> K{BlockPattern(std::move(neighbours))};
    for (std::int32_t j = 0; j < 2; ++j) {
        for (std::int32_t i = 0; i < 2; ++i) {
            K.add(j, K.pattern().rank(j, i), (i == j ? 1.0 : -1.0) * Matrix3<double>::Identity());
        }
    }
    ScalarMetric<double> metric;
    CHECK(refusal([&] {
              metric.factorize(K, "stiffness of two free masses");
          }).starts_with("stiffness of two free masses"));
}
