// SPDX-License-Identifier: MIT
#include <softtissue/mesh/ray_distance.hpp>

#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace softtissue;

TEST_CASE_TEMPLATE("from the axis of a capsule to its facets", S, float, double) {
    const CapsuleBody<S> body;
    const RayDistance<S> distance(body.positions, body.faces);
    const double sector = 2 * std::numbers::pi / body.num_sectors;
    for (int k = 0; k < 64; ++k) {  // with the rays through edges and vertices
        const double angle = k * sector / 4;
        const Vector3<S> d(S(std::cos(angle)), S(0), S(-std::sin(angle)));
        const double in_sector = std::remainder(angle - sector / 2, sector);
        const double expected = 0.1 * std::cos(sector / 2) / std::cos(in_sector);
        for (const double y : {0.4, 0.5, 0.61}) {
            const Vector3<S> o(S(0), S(y), S(0));
            CHECK(double(distance(o, d)) == doctest::Approx(expected).epsilon(1e-5));
            CHECK(double(distance(o, Vector3<S>(S(2) * d))) == doctest::Approx(expected / 2).epsilon(1e-5));
            // From outside, the first of two hits.
            const Vector3<S> far = o + S(1) * d;
            CHECK(double(distance(far, Vector3<S>(-d))) == doctest::Approx(1 - expected).epsilon(1e-5));
            CHECK(distance(far, d) == std::numeric_limits<S>::infinity());
        }
    }
}

TEST_CASE("the tree finds what a search over all triangles finds") {
    const CapsuleBody<double> body;
    const RayDistance<double> all(body.positions, body.faces);
    RandomGenerator random(4);
    int hits = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const Vector3<double> o(random.uniform(-0.3, 0.3), random.uniform(-0.3, 1.3), random.uniform(-0.3, 0.3));
        const Vector3<double> d = random_unit<Vector3<double>>(random);
        double nearest = std::numeric_limits<double>::infinity();
        for (Index t = 0; t < body.faces.cols(); ++t) {
            const Vector3<double> a = body.positions.col(body.faces(0, t));
            Matrix3<double> A;
            A << body.positions.col(body.faces(1, t)) - a, body.positions.col(body.faces(2, t)) - a, -d;
            const Matrix3<double> inverse = A.inverse();
            const Vector3<double> vws = inverse * (o - a);
            if (vws.minCoeff() >= 0 && vws(0) + vws(1) <= 1) {
                nearest = std::min(nearest, vws(2));
            }
        }
        hits += std::isfinite(nearest) ? 1 : 0;
        CHECK((all(o, d) == nearest || std::abs(all(o, d) - nearest) < 1e-12));
    }
    CHECK(hits > 20);
    CHECK(hits < 150);
}
