// SPDX-License-Identifier: MIT
#include <softtissue/ndg/vertex_network.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("offsets are the network's outputs", S, float, double) {
    Mlp<S> mlp({.inputs = 4, .hidden = {8}, .outputs = 6});
    mlp.initialize(3);
    VertexNetwork<S> network(mlp);
    CHECK(network.num_vertices() == 2);
    const VectorX<S> input = VectorX<S>::LinSpaced(4, S(-1), S(1));
    VectorX<S> expected(6);
    auto scratch = mlp.make_scratch(1);
    mlp.infer_into(input, scratch, expected);
    CHECK(network.predict(input) == expected);
    CHECK(network.offsets() == expected);
}

TEST_CASE("what is no vertex network is refused") {
    const Mlp<float> mlp({.inputs = 4, .hidden = {}, .outputs = 7});
    CHECK_THROWS_WITH_AS(VertexNetwork<float>{mlp}, "vertex network: 7 outputs, expected three for each free vertex",
                         InvalidInput);
    const Mlp<float> six({.inputs = 4, .hidden = {}, .outputs = 6});
    VertexNetwork<float> network(six);
    CHECK_THROWS_WITH_AS(network.predict(VectorX<float>::Zero(3)), "vertex network: 3 inputs, expected 4",
                         InvalidInput);
}
