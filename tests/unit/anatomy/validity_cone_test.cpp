// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/validity_cone.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace softtissue;

namespace {

template <class S>
Matrix3X<S> random_normals(RandomGenerator& random, Index count, double spread) {
    Matrix3X<S> normals(3, count);
    for (Index k = 0; k < count; ++k) {
        normals.col(k) << S(spread * random.uniform(-1, 1)), S(spread * random.uniform(-1, 1)), S(1);
    }
    normals.colwise().normalize();
    return normals;
}

}  // namespace

TEST_CASE_TEMPLATE("known cones", S, float, double) {
    const S tolerance = S(16) * std::numeric_limits<S>::epsilon();
    const Matrix3X<S> flat = Vector3<S>::UnitZ().replicate(1, 5);
    CHECK(best_inward_direction<S>(flat).cosine == doctest::Approx(1.0));
    CHECK((best_inward_direction<S>(flat).direction + Vector3<S>::UnitZ()).norm() <= tolerance);

    const Matrix3X<S> corner = Matrix3<S>::Identity();
    CHECK(best_inward_direction<S>(corner).cosine == doctest::Approx(1 / std::sqrt(3.0)));

    Matrix3X<S> edge(3, 4);
    edge << 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1;
    CHECK(best_inward_direction<S>(edge).cosine == doctest::Approx(std::sqrt(0.5)));

    Matrix3X<S> folded(3, 3);
    folded << 0, 0, 1, 0, 0, 0, 1, -1, 0;
    CHECK(best_inward_direction<S>(folded).cosine <= tolerance);
}

TEST_CASE_TEMPLATE("no direction sees all triangles better than the best", S, float, double) {
    RandomGenerator random(11);
    for (int sample = 0; sample < 20; ++sample) {
        const Matrix3X<S> normals = random_normals<S>(random, 3 + sample % 6, 0.5 + 0.1 * sample);
        const InwardDirection<S> best = best_inward_direction<S>(normals);
        CHECK(best.cosine == doctest::Approx(double(smallest_cosine(normals, best.direction))));
        S sampled(-1);
        for (int k = 0; k < 4000; ++k) {
            const Vector3<S> near = best.direction + S(std::pow(10.0, -random.uniform(0, 3))) *
                                                         Vector3<S>(S(random.uniform(-1, 1)), S(random.uniform(-1, 1)),
                                                                    S(random.uniform(-1, 1)));
            sampled = std::max(sampled, smallest_cosine<S>(normals, near.normalized()));
        }
        CHECK(sampled <= best.cosine + S(16) * std::numeric_limits<S>::epsilon());
        CHECK(sampled >= best.cosine - S(0.02));
    }
}

TEST_CASE_TEMPLATE("a direction is moved only as far as wanted", S, float, double) {
    RandomGenerator random(5);
    const S tolerance = S(64) * std::numeric_limits<S>::epsilon();
    for (int sample = 0; sample < 30; ++sample) {
        const Matrix3X<S> normals = random_normals<S>(random, 5, 1.0);
        const InwardDirection<S> best = best_inward_direction<S>(normals);
        const S wanted = S(0.6) * best.cosine;
        const Vector3<S> u =
            Vector3<S>(S(random.uniform(-2, 2)), S(random.uniform(-2, 2)), S(random.uniform(-1, 1))).normalized();
        const Vector3<S> moved = moved_into_cone<S>(normals, u, best.direction, wanted);
        CHECK(moved.norm() == doctest::Approx(1.0));
        if (smallest_cosine(normals, u) >= wanted) {
            CHECK(moved == u);
        } else {
            CHECK(smallest_cosine(normals, moved) == doctest::Approx(double(wanted)).epsilon(1e-4));
            CHECK(smallest_cosine(normals, moved) >= wanted - tolerance);
        }
        CHECK((moved_into_cone<S>(normals, u, best.direction, S(2)) - best.direction).norm() <= tolerance);
    }
    // Straight against the best direction there is no arc; the best direction itself is taken.
    const Matrix3X<S> corner = Matrix3<S>::Identity();
    const InwardDirection<S> best = best_inward_direction<S>(corner);
    const Vector3<S> moved = moved_into_cone<S>(corner, -best.direction, best.direction, S(0.3));
    CHECK(smallest_cosine(corner, moved) >= S(0.3));
}
