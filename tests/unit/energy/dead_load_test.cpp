// SPDX-License-Identifier: MIT
#include <softtissue/energy/dead_load.hpp>

#include <softtissue/energy/concepts.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(EnergyTerm<DeadLoad<double>>);

TEST_CASE_TEMPLATE("the energy is minus the work of the forces in the world", Scalar, float, double) {
    RandomGenerator random(1);
    using Columns = Eigen::Matrix<Scalar, 3, 2>;
    const Matrix3X<Scalar> forces = random_normal<Columns>(random), d = random_normal<Columns>(random);
    const SequentialExecutor executor;
    const Scalar tolerance = Scalar(32) * std::numeric_limits<Scalar>::epsilon();
    DeadLoad<Scalar> load(forces);
    CHECK(std::abs(load.energy(d, executor) + forces.cwiseProduct(d).sum()) < tolerance);

    Placement<Scalar> placement{random_normal<Columns>(random), random_normal<Eigen::Matrix<Scalar, 3, 6>>(random)};
    load.set_placement(placement);
    Matrix3X<Scalar> x;
    placement.positions_into(d, x);
    const Matrix3X<Scalar> moved = x - placement.origins;
    CHECK(std::abs(load.energy(d, executor) + forces.cwiseProduct(moved).sum()) < tolerance);
    Matrix3X<Scalar> gradient = Matrix3X<Scalar>::Zero(3, 2);
    load.add_gradient(d, gradient, executor);
    CHECK(std::abs(gradient.cwiseProduct(d).sum() - load.energy(d, executor)) < tolerance);  // linear in d

    load.set_forces(Matrix3X<Scalar>::Zero(3, 2));
    CHECK(load.energy(d, executor) == Scalar(0));
}

TEST_CASE("a constant force has no stiffness") {
    DeadLoad<double> load(Matrix3X<double>::Ones(3, 1));
    BlockMatrix<double> hessian{BlockPattern(std::vector<std::vector<std::int32_t>>(1))};
    load.bind(PrescribedVertices(1, {}), hessian.pattern());
    load.add_hessian(Matrix3X<double>::Zero(3, 1), PsdFilter::none, hessian, SequentialExecutor{});
    CHECK(hessian.matrix().norm() == 0.0);
}
