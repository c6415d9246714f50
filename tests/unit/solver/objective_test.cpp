// SPDX-License-Identifier: MIT
#include <softtissue/solver/objective.hpp>

#include <softtissue/energy/dead_load.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/field.hpp>

#include <support/separable_energy.hpp>
#include <support/solid_block.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("energy, gradient and Hessian are sums over terms, on the free vertices") {
    const auto block = solid_block<Tet4>({.n = 2, .noise = 0.05});
    const Index n = block.mesh.num_vertices();
    ElasticEnergy<Tet4, UniformField<Arap<double>>> elastic(block.mesh, UniformField{Arap<double>({.stiffness = 10})});
    SeparableEnergy<double, Spring<double>> springs{{.stiffness = 3, .centre = 0.1}};
    RandomGenerator random(1);
    DeadLoad<double> load(random_displacement<double>(n, 1, random));
    const SequentialExecutor executor;
    const PrescribedVertices held(n, block.bottom);
    Objective objective(held, executor, elastic, springs, load);
    const Matrix3X<double> d = random_displacement<double>(n, 0.05, random);

    CHECK(objective.energy(d) ==
          doctest::Approx(elastic.energy(d, executor) + springs.energy(d, executor) + load.energy(d, executor)));
    Matrix3X<double> forces = Matrix3X<double>::Zero(3, n);
    elastic.add_gradient(d, forces, executor);
    springs.add_gradient(d, forces, executor);
    load.add_gradient(d, forces, executor);
    CHECK((objective.full_gradient(d) - forces).norm() < 1e-13 * forces.norm());
    VectorX<double> free_forces;
    held.restrict_into(forces, free_forces);
    CHECK((objective.gradient(d) - free_forces).norm() < 1e-13 * forces.norm());

    // the Hessian along a direction of the free vertices is the change of the gradient
    const VectorX<double> direction = VectorX<double>::NullaryExpr(3 * held.num_free(), [&] { return random.normal(); });
    Matrix3X<double> forwards = d, backwards = d;
    const double h = 1e-5;
    held.add_into(direction, h, forwards);
    held.add_into(direction, -h, backwards);
    const VectorX<double> after = objective.gradient(forwards);
    const VectorX<double> difference = (after - objective.gradient(backwards)) / (2 * h);
    const VectorX<double> product = objective.hessian(d, PsdFilter::none).matrix() * direction;
    CHECK((product - difference).norm() < 1e-7 * product.norm());
    CHECK(objective.hessian(d, PsdFilter::none).matrix().rows() == 3 * held.num_free());
}

TEST_CASE("a second evaluation allocates nothing") {
    const auto block = solid_block<Tet4>({.n = 2});
    const Index n = block.mesh.num_vertices();
    ElasticEnergy<Tet4, UniformField<Arap<double>>> elastic(block.mesh, UniformField{Arap<double>()});
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(n, block.bottom), executor, elastic);
    const Matrix3X<double> d = 0.1 * block.mesh.rest_positions;
    const auto evaluate = [&] {
        return objective.energy(d) + objective.gradient(d).norm() +
               objective.hessian(d, PsdFilter::absolute).matrix().valuePtr()[0];
    };
    const double first = evaluate();
    Eigen::internal::set_is_malloc_allowed(false);
    const double second = evaluate();
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(first == second);
}
