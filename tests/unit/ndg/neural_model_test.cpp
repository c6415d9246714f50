// SPDX-License-Identifier: MIT
#include <softtissue/ndg/neural_model.hpp>

#include <support/limb_model.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class Change>
std::string refusal(const NetworkOptions& options, const Change& change) {
    NeuralModel<float> model = random_limb_model<float>(options, 1.0);
    change(model);
    try {
        model.validate("m");
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a model whose parts fit together is valid, in all variants") {
    for (const NetworkKind kind : {NetworkKind::gradient, NetworkKind::vertex}) {
        for (const bool shape_input : {true, false}) {
            const NetworkOptions options{.kind = kind, .shape_input = shape_input};
            CHECK(refusal(options, [](NeuralModel<float>&) {}).empty());
            CHECK(random_limb_model<float>(options, 1.0).num_shape_inputs() == (shape_input ? 2 : 0));
        }
    }
}

TEST_CASE("what does not fit is named") {
    using Model = NeuralModel<float>;
    CHECK(refusal({}, [](Model& m) { m.body.parents.push_back(0); }) ==
          "m: a network of 11 inputs, expected 18 of the pose and 2 of the shape");
    CHECK(refusal({}, [](Model& m) { m.options.shape_input = false; }) ==
          "m: a network of 11 inputs, expected 9 of the pose and 0 of the shape");
    CHECK(refusal({}, [](Model& m) { m.body.num_cells = 359; }) ==
          "m: a network of 3240 outputs, expected nine for each of 359 cells");
    CHECK(refusal({}, [](Model& m) { m.body.num_vertices = 299; }) == "m: a shape space of 300 vertices, expected 299");
    CHECK(refusal({.kind = NetworkKind::vertex}, [](Model& m) { m.body.num_vertices = 100; }) ==
          "m: a network of 480 outputs, expected three for each free one of 100 vertices");
    CHECK(refusal({}, [](Model& m) { m.mlp.parameters()(17) = std::numeric_limits<float>::quiet_NaN(); }) ==
          "m: a weight of the network is not finite");
}
