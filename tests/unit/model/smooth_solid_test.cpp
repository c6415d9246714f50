// SPDX-License-Identifier: MIT
#include <softtissue/model/smooth_solid.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace softtissue;

namespace {

/// Second difference quotient of f at t, from the left and from the right.
template <class F>
double second_derivative(const F& f, double t, double h) {
    return (f(t + h) - 2.0 * f(t) + f(t - h)) / (h * h);
}

}  // namespace

TEST_CASE("smooth_union: symmetric, at most the minimum, equal to it beyond the blend") {
    for (const double a : {-0.2, 0.0, 0.03, 0.1}) {
        for (const double b : {-0.1, 0.02, 0.031, 0.3}) {
            const double u = smooth_union(a, b, 0.05);
            CHECK(u == smooth_union(b, a, 0.05));
            CHECK(u <= std::min(a, b));
            CHECK(u >= std::min(a, b) - 0.05 / 6.0);
            if (std::abs(a - b) >= 0.05) {
                CHECK(u == std::min(a, b));
            }
            CHECK(smooth_intersection(a, b, 0.05) == -smooth_union(-a, -b, 0.05));
        }
    }
    CHECK(smooth_union(0.1, 0.1, 0.06) == doctest::Approx(0.1 - 0.01));
}

TEST_CASE("smooth_union: second derivative is continuous where the branches meet") {
    const auto f = [](double t) { return smooth_union(t, 0.0, 0.1); };
    // |f'''| <= 1 / k^2 = 100: across a step of 2e-4 the curvature of a C2 function moves by 0.02, rounding adds 1e-8.
    for (const double t : {-0.1, 0.0, 0.1}) {
        CHECK(std::abs(second_derivative(f, t + 1e-4, 1e-4) - second_derivative(f, t - 1e-4, 1e-4)) < 0.05);
    }
}

TEST_CASE("Ellipsoid: zero on its surface, negative inside, exact for a sphere") {
    const Ellipsoid sphere{{1.0, 2.0, 3.0}, {0.5, 0.5, 0.5}};
    CHECK(sphere.distance({1.0, 2.0, 4.0}) == doctest::Approx(0.5));
    CHECK(sphere.distance({1.0, 2.2, 3.0}) == doctest::Approx(-0.3));
    const Ellipsoid e{{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    CHECK(e.distance({0.0, 2.0, 0.0}) == doctest::Approx(0.0));
    CHECK(e.distance({0.6, 1.6, 0.0}) == doctest::Approx(0.0));
    CHECK(e.distance({0.0, 0.0, 0.0}) == doctest::Approx(-1.0));
    CHECK(e.distance({0.0, 0.0, 3.001}) == doctest::Approx(0.001).epsilon(0.01));
}

TEST_CASE("TaperedCapsule: radii at its ends and round caps") {
    const TaperedCapsule c{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.2, 0.1};
    CHECK(c.distance({0.2, 0.0, 0.0}) == doctest::Approx(0.0));
    CHECK(c.distance({0.0, 1.1, 0.0}) == doctest::Approx(0.0));
    CHECK(c.distance({0.3, 0.5, 0.0}) == doctest::Approx(0.15));
}

TEST_CASE("Tube: half widths of its sections, in all four directions and at the ends") {
    // Axis along -y, front +z: the side direction is +x.
    const Tube tube(
        {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
        {{0.0, 0.10, 0.08, 0.06, 0.05}, {0.5, 0.12, 0.09, 0.07, 0.06, 0.01}, {1.0, 0.10, 0.08, 0.06, 0.05}});
    const double exact = 1e-12;
    CHECK(std::abs(tube.distance({0.10, 1.0, 0.0})) < exact);
    CHECK(std::abs(tube.distance({-0.08, 1.0, 0.0})) < exact);
    CHECK(std::abs(tube.distance({0.0, 1.0, 0.06})) < exact);
    CHECK(std::abs(tube.distance({0.0, 1.0, -0.05})) < exact);
    CHECK(std::abs(tube.distance({0.12, 0.5, 0.01})) < exact);
    CHECK(std::abs(tube.distance({0.0, 0.5, 0.08})) < exact);
    CHECK(std::abs(tube.distance({0.0, 1.05, 0.0})) < exact);  // cap: the smallest half width
    CHECK(tube.distance({0.0, 0.5, 0.0}) < 0.0);
    CHECK(tube.distance({0.5, 0.5, 0.0}) > 0.2);
}

TEST_CASE("sample_distance: value and gradient of a smooth function") {
    const auto f = [](const Vector3<double>& x) { return x(0) * x(1) + 2.0 * x(2) * x(2); };
    const DistanceSample s = sample_distance(f, {0.3, 0.2, -0.1});
    // The mixed second derivative (1) enters the gradient times the step (1e-5), the pure ones (4) the value times its
    // square.
    CHECK(std::abs(s.value - 0.08) < 1e-9);
    CHECK((s.gradient - Vector3<double>(0.2, 0.3, -0.4)).norm() < 1.01e-5);
}
