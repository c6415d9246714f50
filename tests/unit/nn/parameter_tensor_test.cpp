// SPDX-License-Identifier: MIT
#include <softtissue/nn/parameter_tensor.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("the size is the product of the shape") {
    CHECK(ParameterTensor{"0.weight", {7, 5}, 3}.size() == 35);
    CHECK(ParameterTensor{"0.bias", {7}, 38}.size() == 7);
    CHECK(ParameterTensor{"scale", {}, 0}.size() == 1);
}
