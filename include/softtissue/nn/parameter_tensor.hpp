// SPDX-License-Identifier: MIT
/// @file
/// Where the tensors of a network lie in its one vector of parameters.
///
/// What        name, shape and place of a tensor; an optimiser, a checkpoint and a file need no more
/// Shapes      entries in C order: a weight is (outputs, inputs), row after row, as PyTorch stores it
/// Names       PyTorch's state_dict without prefix: "0.weight", "0.bias", ...
/// Tests       tests/unit/nn/parameter_tensor_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <string>
#include <vector>

namespace softtissue {

struct ParameterTensor {
    std::string name;
    std::vector<Index> shape;
    Index offset = 0;  ///< of the first entry in the vector of parameters

    Index size() const {
        Index entries = 1;
        for (const Index extent : shape) {
            entries *= extent;
        }
        return entries;
    }
};

}  // namespace softtissue
