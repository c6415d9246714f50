// SPDX-License-Identifier: MIT
#include <softtissue/energy/hinge_invariants.hpp>

#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

template <class S>
Matrix3<S> folded(double angle) {
    Matrix3<S> edges;
    edges << S(2), S(0.5), S(0.7),                   //
        S(0), S(1.5), S(-0.8 * std::cos(angle)),     //
        S(0), S(0), S(-0.8 * std::sin(angle));
    return edges;
}

}  // namespace

TEST_CASE_TEMPLATE("the angle of a fold: 0 flat, positive convex, any frame, any size", S, float, double) {
    RandomGenerator random(1);
    const S epsilon = std::numeric_limits<S>::epsilon();
    for (const double angle : {-3.1, -1.0, 0.0, 0.2, 1.6, 3.1}) {
        const HingeInvariants<S> hinge(folded<S>(angle));
        CHECK(std::abs(hinge.angle() - S(angle)) < 4 * epsilon);
        const HingeInvariants<S> moved(S(0.3) * random_rotation<S>(random) * folded<S>(angle));
        CHECK(std::abs(moved.angle() - S(angle)) < 16 * epsilon);
    }
    CHECK(std::abs(HingeInvariants<S>(folded<S>(std::numbers::pi)).angle()) == doctest::Approx(std::numbers::pi));
}

TEST_CASE("the values are products of normals and lengths") {
    const HingeInvariants<double> hinge(folded<double>(0.4));
    const double n1 = 2 * 1.5, n2 = 2 * 0.8;
    CHECK(hinge.values()(hinge_cosine) == doctest::Approx(n1 * n2 * std::cos(0.4)));
    CHECK(2 * hinge.values()(hinge_sine) == doctest::Approx(n1 * n2 * std::sin(0.4)));
    CHECK(hinge.values()(hinge_first_area) == doctest::Approx(n1 * n1));
    CHECK(hinge.values()(hinge_second_area) == doctest::Approx(n2 * n2));
    CHECK(hinge.values()(hinge_length) == doctest::Approx(4.0));
}

TEST_CASE_TEMPLATE("the derivatives are derivatives, also where triangles have no area", S, float, double) {
    using Values = typename HingeInvariants<S>::Values;
    RandomGenerator random(2);
    for (int sample = 0; sample < 8; ++sample) {
        Matrix3<S> edges = random_normal<Matrix3<S>>(random);
        if (sample % 4 == 1) {
            edges.col(1) = S(0.5) * edges.col(0);
        } else if (sample % 4 == 2) {
            edges.col(0).setZero();
        }
        const Matrix3<S> D = random_normal<Matrix3<S>>(random);
        const HingeInvariants<S> hinge(edges);
        const auto values = [&](S h) -> Values { return HingeInvariants<S>(edges + h * D).values(); };
        const Values slope = hinge.jacobian() * vec<S>(D);
        CHECK(taylor_rate(values, slope).is_at_least(2));
        const Values c = random_normal<Values>(random);
        const auto gradient = [&](S h) -> Vector9<S> {
            return HingeInvariants<S>(edges + h * D).jacobian().transpose() * c;
        };
        const Vector9<S> change = hinge.contracted_hessian(c) * vec<S>(D);
        CHECK(taylor_rate(gradient, change).is_at_least(2));
    }
}
