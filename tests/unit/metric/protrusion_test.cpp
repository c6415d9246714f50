// SPDX-License-Identifier: MIT
#include <softtissue/metric/protrusion.hpp>

#include <support/capsule_body.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// The capsule at half its size around the same middle.
template <class S>
Matrix3X<S> inner_capsule(const CapsuleBody<S>& skin) {
    Matrix3X<S> inner = S(0.5) * skin.positions;
    inner.row(1).array() += S(0.25);
    return inner;
}

}  // namespace

TEST_CASE_TEMPLATE("what is inside or on the skin does not protrude", S, float, double) {
    const CapsuleBody<S> skin;
    const Protrusion<S> inside = compute_protrusion(skin.positions, skin.faces, inner_capsule(skin));
    CHECK(!inside.is_present());
    CHECK(inside.magnitude == S(0));
    CHECK(inside.mean == S(0));
    CHECK(inside.worst_vertex == -1);
    // At a vertex of a convex skin the winding number is below 1/2.
    CHECK(!compute_protrusion(skin.positions, skin.faces, skin.positions).is_present());
    CHECK(!compute_protrusion(skin.positions, skin.faces, Matrix3X<S>(3, 0)).is_present());
}

TEST_CASE_TEMPLATE("vertices pulled out by known distances", S, float, double) {
    const CapsuleBody<S> skin;
    Matrix3X<S> inner = inner_capsule(skin);
    inner.col(7) << S(0), S(1.25), S(0);    // 0.25 m above the upper pole
    inner.col(40) << S(0), S(-0.05), S(0);  // 0.05 m below the lower one
    const Protrusion<S> protrusion = compute_protrusion(skin.positions, skin.faces, inner);
    CHECK(protrusion.num_vertices == 2);
    CHECK(protrusion.magnitude == doctest::Approx(0.25).epsilon(1e-5));
    CHECK(protrusion.mean == doctest::Approx(0.15).epsilon(1e-5));
    CHECK(protrusion.worst_vertex == 7);
}

TEST_CASE("noisy points: the same as the exact winding number and the distances to all triangles") {
    const CapsuleBody<double> skin;
    RandomGenerator random(5);
    Matrix3X<double> inner(3, 300);
    for (Index v = 0; v < inner.cols(); ++v) {
        inner.col(v) << random.uniform(-0.2, 0.2), random.uniform(-0.2, 1.2), random.uniform(-0.2, 0.2);
    }
    const WindingNumber<double> winding(skin.positions, skin.faces);
    Index count = 0;
    double magnitude = 0;
    double sum = 0;
    for (Index v = 0; v < inner.cols(); ++v) {
        const Vector3<double> p = inner.col(v);
        if (winding.exact(p) > 0.5) {
            continue;
        }
        double nearest = std::numeric_limits<double>::infinity();
        for (Index t = 0; t < skin.faces.cols(); ++t) {
            nearest = std::min(
                nearest,
                closest_point_on_triangle<double>(triangle_corners(skin.positions, skin.faces, t), p).squared_distance);
        }
        ++count;
        magnitude = std::max(magnitude, std::sqrt(nearest));
        sum += std::sqrt(nearest);
    }
    CHECK(count > 100);
    CHECK(count < 300);
    for (const int threads : {1, 3}) {
        const Protrusion<double> found = compute_protrusion(skin.positions, skin.faces, inner, ThreadExecutor(threads));
        CHECK(found.num_vertices == count);
        CHECK(found.magnitude == magnitude);
        CHECK(found.mean == doctest::Approx(sum / double(count)).epsilon(1e-12));
    }
}

TEST_CASE("a skin with a hole in it still separates") {
    const CapsuleBody<double> skin;
    const Triangles open = skin.faces.rightCols(skin.faces.cols() - 40);
    CHECK(!compute_protrusion(skin.positions, open, Matrix3X<double>(Vector3<double>(0, 0.7, 0))).is_present());
    CHECK(compute_protrusion(skin.positions, open, Matrix3X<double>(Vector3<double>(0.3, 0.7, 0))).is_present());
}

TEST_CASE("vertices that are not finite and a missing skin are refused") {
    const CapsuleBody<double> skin;
    Matrix3X<double> inner = inner_capsule(skin);
    CHECK_THROWS_WITH_AS(compute_protrusion(skin.positions, Triangles(3, 0), inner),
                         "protrusion: the skin has no triangles", InvalidInput);
    inner(2, 9) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(compute_protrusion(skin.positions, skin.faces, inner),
                         "protrusion: inner vertex 9 is not finite", InvalidInput);
}
