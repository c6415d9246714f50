// SPDX-License-Identifier: MIT
#include <softtissue/metric/intersection.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("a body inside, through and outside another", S, float, double) {
    const CapsuleBody<S> skin;
    Matrix3X<S> inner = S(0.5) * skin.positions;
    inner.row(1).array() += S(0.25);
    CHECK(!compute_intersection(skin.positions, skin.faces, inner, skin.faces).is_present());
    CHECK(compute_intersection(skin.positions, skin.faces, inner, skin.faces).num_pairs == 0);

    // Sideways, until a strip of the inner capsule is out.
    Matrix3X<S> through = inner;
    through.row(0).array() += S(0.07);
    const Intersection crossing = compute_intersection(skin.positions, skin.faces, through, skin.faces);
    CHECK(crossing.is_present());
    CHECK(crossing.num_pairs == compute_intersection(through, skin.faces, skin.positions, skin.faces).num_pairs);

    Matrix3X<S> outside = inner;
    outside.row(0).array() += S(0.3);
    CHECK(!compute_intersection(skin.positions, skin.faces, outside, skin.faces).is_present());
    CHECK(!compute_intersection(skin.positions, skin.faces, inner, Triangles(3, 0)).is_present());
}
