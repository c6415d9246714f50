// SPDX-License-Identifier: MIT
#include <softtissue/energy/dihedral_chord.hpp>

#include <softtissue/energy/dihedral_difference.hpp>
#include <softtissue/energy/hinge_bending.hpp>

#include <support/hinge_measure_laws.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace softtissue;
using namespace softtissue_test;

static_assert(HingeMeasure<DihedralChord<float>>);
static_assert(HingeMeasure<DihedralChord<double>>);

namespace {

template <class S>
DihedralChord<S> chord(const Matrix3<S>& rest) {
    return DihedralChord<S>(HingeInvariants<S>(rest));
}

double energy_at(const DihedralChord<double>& measure, const Matrix3<double>& edges) {
    return measure.energy(HingeInvariants<double>(edges));
}

}  // namespace

TEST_CASE("the energy is w (1 - cos) of the change of angle while the triangles keep a quarter of their area") {
    const DihedralChord<double> measure = chord<double>(hinge_edges<double>(0.4));
    CHECK(measure.weight() == doctest::Approx(6.0 / 1.5));
    for (const double angle : {-3.0, -0.5, 0.4, 1.7, 3.1}) {
        for (const double shrink : {0.26, 1.0, 3.0}) {
            const double energy = energy_at(measure, hinge_edges<double>(angle, 0.8 * shrink, 0.7 / shrink));
            CHECK(energy == doctest::Approx(measure.weight() * (1 - std::cos(angle - 0.4))).epsilon(1e-13));
        }
    }
}

TEST_CASE("it agrees with the difference of angles to second order") {
    for (const double rest : {0.0, 1.0, -2.0}) {
        const DihedralChord<double> smooth = chord<double>(hinge_edges<double>(rest));
        const DihedralDifference<double> difference{HingeInvariants<double>(hinge_edges<double>(rest))};
        for (const double change : {0.1, -0.01}) {
            const HingeInvariants<double> bent(hinge_edges<double>(rest + change));
            // 2 (1 - cos x) / x^2 = 1 - x^2 / 12 + ...
            CHECK(std::abs(smooth.energy(bent) / difference.energy(bent) - 1) < change * change / 11);
        }
        const Matrix9<double> H = hessian_by_edges(difference, hinge_edges<double>(rest));
        CHECK((hessian_by_edges(smooth, hinge_edges<double>(rest)) - H).norm() < 1e-12 * H.norm());
        CHECK(gradient_by_edges(smooth, hinge_edges<double>(rest)).norm() == 0.0);
    }
}

TEST_CASE_TEMPLATE("derivatives, also of triangles without area, turned over, and of slivers", S, float, double) {
    RandomGenerator random(1);
    for (const double rest : {0.0, 0.7}) {
        const DihedralChord<S> measure = chord<S>(hinge_edges<S>(rest));
        for (const double height : {0.8, 0.1, 0.0, -0.05, -0.5}) {
            for (const double second_height : {0.7, 0.08, 0.0}) {
                const Matrix3<S> D = S(0.1) * random_normal<Matrix3<S>>(random);
                check_hinge_derivatives<DihedralChord<S>>(measure, hinge_edges<S>(0.5, height, second_height), D);
            }
        }
        Matrix3<S> short_edge = hinge_edges<S>(1.0);
        for (const double length : {0.2, 0.0}) {
            short_edge.col(0) = Vector3<S>(S(length), S(0), S(0));
            const Matrix3<S> D = S(0.1) * random_normal<Matrix3<S>>(random);
            check_hinge_derivatives<DihedralChord<S>>(measure, short_edge, D);
        }
        const DihedralChord<S> sliver = chord<S>(hinge_edges<S>(rest, 0.044));
        check_hinge_derivatives<DihedralChord<S>>(sliver, hinge_edges<S>(0.3, 0.03),
                                                  Matrix3<S>(S(0.02) * random_normal<Matrix3<S>>(random)));
    }
}

TEST_CASE("the Hessian is continuous where the normal begins to shrink") {
    const DihedralChord<double> measure = chord<double>(hinge_edges<double>(0.3));
    const double step = 1e-9;
    for (const double angle : {0.5, 2.0}) {
        const Matrix9<double> above = hessian_by_edges(measure, hinge_edges<double>(angle, 0.2 * (1 + step)));
        const Matrix9<double> below = hessian_by_edges(measure, hinge_edges<double>(angle, 0.2 * (1 - step)));
        // the third derivative is of the order of 1 / height^3
        CHECK((above - below).norm() < 100 * step * above.norm());
        Matrix3<double> shorter = hinge_edges<double>(angle, 4.0, 4.0), longer = shorter;
        shorter(0, 0) = 0.25 * (1 - step);
        longer(0, 0) = 0.25 * (1 + step);
        const Matrix9<double> long_edge = hessian_by_edges(measure, longer);
        CHECK((hessian_by_edges(measure, shorter) - long_edge).norm() < 100 * step * long_edge.norm());
    }
}

TEST_CASE("a fold passes pi without a jump, with period 2 pi") {
    const DihedralChord<double> measure = chord<double>(hinge_edges<double>(0.5));
    constexpr double pi = std::numbers::pi;
    const double step = 1e-6;
    for (double angle = -pi; angle < pi; angle += 0.01) {
        const double change = energy_at(measure, hinge_edges<double>(angle + step)) - energy_at(measure, hinge_edges<double>(angle));
        CHECK(std::abs(change) <= 1.001 * measure.weight() * step);
    }
    const Vector9<double> below = gradient_by_edges(measure, hinge_edges<double>(pi - 1e-9));
    const Vector9<double> above = gradient_by_edges(measure, hinge_edges<double>(pi + 1e-9));
    CHECK((below - above).norm() < 1e-7);
}

TEST_CASE("turning a triangle over costs energy monotonically, with bounded gradient: slivers too") {
    for (const double height : {0.8, 0.044, 0.01, 1e-4}) {  // 0.044: two angles of 5 degrees
        CAPTURE(height);
        const DihedralChord<double> measure = chord<double>(hinge_edges<double>(0.3, height));
        CHECK(measure.weight() <= 6.0 / (0.7 + std::max(0.1, height)) * (1 + 1e-12));
        double last = 0.0;
        for (double h = height; h > -1.5 * height; h -= 0.01 * height) {
            const Matrix3<double> edges = hinge_edges<double>(0.3, h);
            const double energy = energy_at(measure, edges);
            CHECK(energy >= last - 1e-13);
            last = energy;
            // 2 w for the chord's largest length, 15/8 x 4 for the smooth step's slope by relative height
            const Vector9<double> gradient = gradient_by_edges(measure, edges);
            CHECK(gradient.norm() < 2 * measure.weight() * 7.5 * (2 / height + 2 / 0.7));
        }
        CHECK(last == doctest::Approx(2 * measure.weight()));
        // lifting a vertex off the hinge: a stiffness that slivers do not raise without bound
        CHECK(measure.weight() / (height * height) < 600.0 / (0.7 + std::max(0.1, height)) * (1 + 1e-12));
    }
}

TEST_CASE_TEMPLATE("nothing is lost without area at rest", S, float, double) {
    for (const Matrix3<S>& rest : {hinge_edges<S>(0.2, 0.0), hinge_edges<S>(0.2, 0.0, 0.0), hinge_edges<S>(0.0, 1e-9)}) {
        const DihedralChord<S> measure = chord<S>(rest);
        for (const double angle : {0.0, 0.5, 3.0}) {
            for (const double height : {0.0, 1e-9, 0.3}) {
                const Matrix3<S> edges = hinge_edges<S>(angle, height);
                const S bound = S(1e-6);
                CHECK(measure.energy(HingeInvariants<S>(edges)) <= bound);
                CHECK(gradient_by_edges(measure, edges).allFinite());
                CHECK(hessian_by_edges(measure, edges).allFinite());
            }
        }
    }
}
