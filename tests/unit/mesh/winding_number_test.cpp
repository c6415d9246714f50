// SPDX-License-Identifier: MIT
#include <softtissue/mesh/winding_number.hpp>

#include <support/capsule_body.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

/// Around the capsule's axis (y from 0 to 1, radius 0.1), 0.4 m to all sides.
template <class S>
Matrix3X<S> points_around(Index count, std::uint64_t seed) {
    RandomGenerator random(seed);
    Matrix3X<S> points(3, count);
    for (Index p = 0; p < count; ++p) {
        points.col(p) << S(random.uniform(-0.4, 0.4)), S(random.uniform(-0.4, 1.4)), S(random.uniform(-0.4, 0.4));
    }
    return points;
}

/// 0.3 to 3 cm off a random place of a triangle.
Matrix3X<double> points_near(const Matrix3X<double>& positions, const Triangles& triangles, Index count) {
    RandomGenerator random(2);
    Matrix3X<double> points(3, count);
    for (Index p = 0; p < count; ++p) {
        const Matrix3<double> corners = triangle_corners(positions, triangles, random.index(triangles.cols()));
        points.col(p) = corners.rowwise().mean() + random_unit<Vector3<double>>(random) * random.uniform(0.003, 0.03);
    }
    return points;
}

/// The triangles above y = 0.7 are gone.
Triangles open_capsule(const CapsuleBody<double>& body) {
    Triangles open(3, body.faces.cols());
    Index count = 0;
    for (Index t = 0; t < body.faces.cols(); ++t) {
        if (triangle_corners(body.positions, body.faces, t).row(1).maxCoeff() < 0.7) {
            open.col(count++) = body.faces.col(t);
        }
    }
    return open.leftCols(count);
}

double largest_error(const WindingNumber<double>& winding, const Matrix3X<double>& points) {
    double error = 0;
    for (Index p = 0; p < points.cols(); ++p) {
        error = std::max(error, std::abs(winding(points.col(p)) - winding.exact(points.col(p))));
    }
    return error;
}

}  // namespace

TEST_CASE_TEMPLATE("the solid angle of an octant, from both sides", S, float, double) {
    Matrix3<S> corners = Matrix3<S>::Identity();
    CHECK(solid_angle<S>(corners) == doctest::Approx(std::numbers::pi / 2));
    corners.col(0).swap(corners.col(1));
    CHECK(solid_angle<S>(corners) == doctest::Approx(-std::numbers::pi / 2));
    const Matrix3<S> near_plane = Matrix3<S>::Identity() - Matrix3<S>::Constant(S(0.333));  // almost half the sphere
    CHECK(solid_angle<S>(near_plane) == doctest::Approx(2 * std::numbers::pi).epsilon(0.01));
    const Matrix3<S> large = S(1e6) * Matrix3<S>::Identity();
    CHECK(solid_angle<S>(large) == doctest::Approx(std::numbers::pi / 2));
}

TEST_CASE_TEMPLATE("1 inside, 0 outside of a closed surface, 2 inside a doubled one", S, float, double) {
    const CapsuleBody<S> body;
    const WindingNumber<S> winding(body.positions, body.faces);
    Triangles twice(3, 2 * body.faces.cols());
    twice << body.faces, body.faces;
    const WindingNumber<S> doubled(body.positions, twice);
    const Matrix3X<S> points = points_around<S>(200, 1);
    const S rounding = S(2000) * std::numeric_limits<S>::epsilon();  // of a sum over 992 triangles
    int num_inside = 0;
    for (Index p = 0; p < points.cols(); ++p) {
        const Vector3<S> q = points.col(p);
        const S to_axis = std::hypot(q(0), q(2));
        // The capsule's rings have 16 corners: their sides are up to 2 % closer to the axis.
        const bool is_inside = q(1) > S(0.1) && q(1) < S(0.9) && to_axis < S(0.095);
        const bool is_outside = q(1) < S(0) || q(1) > S(1) || to_axis > S(0.1);
        if (is_inside || is_outside) {
            num_inside += is_inside ? 1 : 0;
            CHECK(std::abs(winding.exact(q) - (is_inside ? S(1) : S(0))) <= rounding);
            CHECK(std::abs(winding(q) - (is_inside ? S(1) : S(0))) <= S(1.5e-2));
            CHECK(std::abs(doubled.exact(q) - (is_inside ? S(2) : S(0))) <= rounding);
        }
    }
    for (int k = 0; k < 20; ++k) {
        const Vector3<S> q(S(0.01 * (k % 5)), S(0.1 + 0.04 * k), S(0.02));
        CHECK(std::abs(winding.exact(q) - S(1)) <= rounding);
    }
    CHECK(num_inside < 100);
}

TEST_CASE("far clusters keep the error that the separation promises") {
    const CapsuleBody<double> body;
    const Triangles open = open_capsule(body);
    // A soup: the triangles in random places, directions and sizes.
    RandomGenerator random(4);
    Matrix3X<double> soup(3, 3000);
    Triangles loose(3, 1000);
    for (Index t = 0; t < 1000; ++t) {
        const Vector3<double> place(random.uniform(-0.2, 0.2), random.uniform(), random.uniform(-0.2, 0.2));
        for (Index k = 0; k < 3; ++k) {
            soup.col(3 * t + k) = place + 0.02 * random_normal<Vector3<double>>(random);
            loose(k, t) = std::int32_t(3 * t + k);
        }
    }
    Matrix3X<double> points(3, 600);
    points << points_around<double>(300, 3), points_near(body.positions, body.faces, 300);
    double previous = 1;
    for (const auto& row : {std::pair(2.0, 1.5e-2), std::pair(4.0, 1e-3), std::pair(8.0, 5e-5)}) {
        const auto separation = row.first;
        const auto promised = row.second;
        CAPTURE(separation);
        const double closed_error = largest_error({body.positions, body.faces, separation}, points);
        const double open_error = largest_error({body.positions, open, separation}, points);
        const double soup_error = largest_error({soup, loose, separation}, points);
        CAPTURE(closed_error);
        CAPTURE(open_error);
        CAPTURE(soup_error);
        const double error = std::max({closed_error, open_error, soup_error});
        CHECK(error <= promised);
        CHECK(error > 0);
        CHECK(error < previous);
        previous = error;
    }
}

TEST_CASE("half a sphere's worth above a large open square, and half a turn on it") {
    Matrix3X<double> positions(3, 4);
    positions << -1e3, 1e3, 1e3, -1e3,  //
        -1e3, -1e3, 1e3, 1e3,           //
        0, 0, 0, 0;
    Triangles triangles(3, 2);
    triangles << 0, 0,  //
        1, 2,           //
        2, 3;
    const WindingNumber<double> winding(positions, triangles);
    CHECK(winding.exact({0.3, 0.1, -1}) == doctest::Approx(0.5).epsilon(2e-3));
    CHECK(winding.exact({0.3, 0.1, 1}) == doctest::Approx(-0.5).epsilon(2e-3));
    CHECK(winding.exact({0.3, 0.1, 0}) == 0);
}

TEST_CASE("on faces, edges and vertices of a cube the sum is finite and between both sides") {
    Matrix3X<double> positions(3, 4);
    positions << 0, 1, 0, 0,  //
        0, 0, 1, 0,           //
        0, 0, 0, 1;
    Triangles triangles(3, 4);
    triangles << 0, 0, 1, 2,  //
        2, 1, 2, 0,           //
        1, 3, 3, 3;
    const WindingNumber<double> tet(positions, triangles);
    CHECK(tet.exact({0.25, 0.25, 0.25}) == doctest::Approx(1));
    CHECK(tet.exact({0.25, 0.25, 0}) == doctest::Approx(0.5));
    CHECK(tet.exact({0.25, 0, 0}) == doctest::Approx(0.25));  // a right angle of two faces
    CHECK(tet.exact({0, 0, 0}) == doctest::Approx(0.125));    // an octant
    CHECK(tet.exact({0.25, 0.25, -1e-9}) == doctest::Approx(0));
    CHECK(tet.exact({0.25, 0.25, 1e-9}) == doctest::Approx(1));
    CHECK(std::isnan(tet.exact({0.25, std::numeric_limits<double>::quiet_NaN(), 0})));
    CHECK(std::isnan(tet({0.25, std::numeric_limits<double>::quiet_NaN(), 0})));
    CHECK(tet({1e12, 0, 0}) == doctest::Approx(0));
}

TEST_CASE("triangles without area and surfaces without triangles add nothing") {
    const CapsuleBody<double> body;
    Triangles more(3, body.faces.cols() + 30);
    more.leftCols(body.faces.cols()) = body.faces;
    for (std::int32_t t = 0; t < 30; ++t) {
        more.col(body.faces.cols() + t) << t, t, 2 * t;
    }
    const WindingNumber<double> winding(body.positions, body.faces);
    const WindingNumber<double> same(body.positions, more);
    const Vector3<double> q(0.03, 0.4, 0.01);
    CHECK(same.exact(q) == doctest::Approx(winding.exact(q)).epsilon(1e-12));
    CHECK(std::abs(same(q) - 1) <= 1.5e-2);
    const WindingNumber<double> nothing(body.positions, Triangles(3, 0));
    CHECK(nothing(q) == 0);
    CHECK(nothing.exact(q) == 0);
}

TEST_CASE_TEMPLATE("moved surfaces, and the same bits for any number of threads", S, float, double) {
    const CapsuleBody<S> body;
    Matrix3X<S> moved = body.positions;
    for (Index v = 0; v < moved.cols(); ++v) {
        moved(0, v) += S(0.2) * moved(1, v) * moved(1, v);
    }
    WindingNumber<S> winding(body.positions, body.faces);
    winding.update(moved);
    const Matrix3X<S> points = points_around<S>(150, 6);
    VectorX<S> expected(150);
    winding.evaluate_into(points, expected);
    const WindingNumber<S> built(moved, body.faces);
    for (Index p = 0; p < points.cols(); ++p) {
        CHECK(std::abs(built(points.col(p)) - expected(p)) <= S(3e-2));
        CHECK(winding(points.col(p)) == expected(p));
    }
    for (const int threads : {2, 7}) {
        VectorX<S> out(150);
        winding.evaluate_into(points, out, ThreadExecutor(threads));
        CHECK(out == expected);
    }
}

TEST_CASE("what has no winding number is refused") {
    CapsuleBody<double> body;
    CHECK_THROWS_WITH_AS(WindingNumber<double>(body.positions, body.faces, 0.5),
                         "winding number: separation = 0.5, expected at least 1", InvalidInput);
    body.positions(0, 3) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(WindingNumber<double>(body.positions, body.faces), InvalidInput);
}
