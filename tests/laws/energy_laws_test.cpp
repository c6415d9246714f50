// SPDX-License-Identifier: MIT
// The energy terms without elements: inertia and dead loads.
#include <softtissue/energy/dead_load.hpp>
#include <softtissue/energy/inertia.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

template <class S>
using Five = Eigen::Matrix<S, 3, 5>;

template <class S>
Placement<S> random_placement(bool with_maps, RandomGenerator& random) {
    Placement<S> placement{random_normal<Five<S>>(random), {}};
    if (with_maps) {
        placement.maps = random_normal<Eigen::Matrix<S, 3, 15>>(random);
    }
    return placement;
}

/// Both derivatives along random directions.
template <class S, class Term>
void check_derivatives(Term& term, RandomGenerator& random) {
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(5, {}), executor, term);
    for (int sample = 0; sample < 5; ++sample) {
        const Matrix3X<S> d = random_normal<Five<S>>(random), D = random_normal<Five<S>>(random);
        const auto energy = [&](S h) { return objective.energy(d + h * D); };
        const S slope = objective.full_gradient(d).cwiseProduct(D).sum();
        CHECK(taylor_rate(energy, slope).is_at_least(2));
        CHECK_FALSE(taylor_rate(energy, S(slope * S(1.1) + S(1))).is_at_least(2));
        const auto gradient = [&](S h) -> Matrix3X<S> { return objective.full_gradient(d + h * D); };
        const VectorX<S> product = objective.hessian(d, PsdFilter::none).matrix() * VectorX<S>(D.reshaped());
        const Matrix3X<S> change = product.reshaped(3, 5);
        CHECK(taylor_rate(gradient, change).is_at_least(2));
    }
}

}  // namespace

TEST_CASE_TEMPLATE("inertia", Scalar, float, double) {
    for (const bool with_maps : {false, true}) {
        RandomGenerator random(1);
        const Placement<Scalar> placement = random_placement<Scalar>(with_maps, random);
        const Matrix3X<Scalar> target = random_normal<Five<Scalar>>(random);
        const VectorX<Scalar> masses = VectorX<Scalar>::NullaryExpr(5, [&] { return Scalar(random.uniform(0, 2)); });
        Inertia<Scalar> inertia(masses, Scalar(0.5));
        inertia.set_step(placement, target);
        check_derivatives<Scalar>(inertia, random);
    }
}

TEST_CASE_TEMPLATE("dead loads", Scalar, float, double) {
    for (const bool with_maps : {false, true}) {
        RandomGenerator random(2);
        const Placement<Scalar> placement = random_placement<Scalar>(with_maps, random);
        DeadLoad<Scalar> load(Matrix3X<Scalar>(random_normal<Five<Scalar>>(random)));
        load.set_placement(placement);
        check_derivatives<Scalar>(load, random);
    }
}
