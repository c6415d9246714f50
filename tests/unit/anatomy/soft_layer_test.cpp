// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/soft_layer.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("columns, levels and body vertices of a layer of one triangle", S, float, double) {
    SoftLayer<S> layer;
    layer.layers = {3, 2};
    layer.region.body_vertices = {4, 7, 9};
    layer.skin_positions = Matrix3<S>::Identity();
    layer.directions = -Matrix3<S>::Identity();
    layer.thickness = Vector3<S>(S(0.5), S(0.25), S(0));
    CHECK(layer.num_columns() == 3);
    CHECK(layer.skin_vertex(1) == 5);
    CHECK(layer.body_vertex(5) == 7);
    CHECK(layer.body_vertex(6) == 9);
    Matrix3X<S> inner = Matrix3X<S>::Zero(3, 3);
    inner.diagonal() << S(0.5), S(0.75), S(1);
    CHECK(layer.inner_positions() == inner);
}

TEST_CASE("the default options are those that the build accepts for a human body in metres") {
    const SoftLayerOptions<double> options;
    CHECK(options.minimum_thickness < options.full_thickness);
    CHECK(options.smallest_cosine < options.wanted_cosine);
    CHECK(!options.region.extremities.has_value());
}
