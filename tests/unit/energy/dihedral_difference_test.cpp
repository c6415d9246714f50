// SPDX-License-Identifier: MIT
#include <softtissue/energy/dihedral_difference.hpp>

#include <softtissue/energy/hinge_bending.hpp>

#include <support/hinge_measure_laws.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;
using namespace softtissue_test;

static_assert(HingeMeasure<DihedralDifference<float>>);
static_assert(HingeMeasure<DihedralDifference<double>>);
static_assert(!HingeMeasure<double>);
static_assert(!HingeMeasure<HingeInvariants<double>>);

TEST_CASE("the energy is that of the source, with a third of the area of both triangles") {
    const DihedralDifference<double> measure{HingeInvariants<double>(hinge_edges<double>(0.3, 0.8, 0.6))};
    CHECK(measure.rest_angle() == doctest::Approx(0.3));
    CHECK(measure.weight() == doctest::Approx(1.0 / ((0.4 + 0.3) / 3)));
    const double energy = measure.energy(HingeInvariants<double>(hinge_edges<double>(-0.9)));
    CHECK(energy == doctest::Approx(0.5 * measure.weight() * 1.2 * 1.2).epsilon(1e-14));
    // as written: the angle is not wrapped
    const double just_below = measure.energy(HingeInvariants<double>(hinge_edges<double>(3.14)));
    const double just_above = measure.energy(HingeInvariants<double>(hinge_edges<double>(3.15)));
    CHECK(just_above > 1.4 * just_below);
}

TEST_CASE_TEMPLATE("derivatives", S, float, double) {
    RandomGenerator random(1);
    for (const double rest : {0.0, 0.7, -1.2}) {
        const DihedralDifference<S> measure{HingeInvariants<S>(hinge_edges<S>(rest))};
        for (const double angle : {0.0, 0.3, -1.9, 2.5}) {
            const Matrix3<S> D = S(0.3) * random_normal<Matrix3<S>>(random);
            check_hinge_derivatives<DihedralDifference<S>>(measure, hinge_edges<S>(angle, 0.9, 0.5), D);
        }
    }
}

TEST_CASE("a rest triangle without area is refused") {
    CHECK_THROWS_WITH_AS(DihedralDifference<double>{HingeInvariants<double>(hinge_edges<double>(0.0, 0.0))},
                         "a rest triangle has no area", InvalidInput);
}
