// SPDX-License-Identifier: MIT
/// @file
/// A network that predicts where vertices would have to rest for linear blend skinning to carry them to their place.
///
/// What        inference of VertexNet: three numbers for each free vertex.
/// Equation    d_v of x_v = LBS(X_v + d_v) (see rest_offsets.hpp)
/// Shapes      input features + shape coefficients; offsets 3 x free vertices, flat [m]
/// Refuses     a network whose outputs are not three a vertex, inputs of another size (InvalidInput)
/// Source      Nolte et al. 2026, eq. (21); Han et al. 2024
/// Departs     the PCA decoder of the source is part of the last linear layer (fold_decoder()): the same function
/// Cost        bytes of the weights. Nothing is allocated after construction.
/// Tests       tests/unit/ndg/vertex_network_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/network_inference.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

namespace softtissue {

template <RealScalar S>
class VertexNetwork {
public:
    using Scalar = S;

    /// The networks must outlive this; `small` takes the place of `mlp` if it is there.
    explicit VertexNetwork(const Mlp<S>& mlp, const QuantizedMlp<S>* small = nullptr)
        : network_(mlp, small), offsets_(mlp.sizes().outputs) {
        require(mlp.sizes().outputs % 3 == 0, "vertex network: ", mlp.sizes().outputs,
                " outputs, expected three for each free vertex");
    }

    Index num_vertices() const { return offsets_.size() / 3; }

    /// d_v of one input, valid until the next call.
    template <Executor E = SequentialExecutor>
    const VectorX<S>& predict(const VectorX<S>& input, const E& executor = {}) {
        require(input.size() == network_.sizes().inputs, "vertex network: ", input.size(), " inputs, expected ",
                network_.sizes().inputs);
        network_.infer_into(input, offsets_, executor);
        return offsets_;
    }

    const VectorX<S>& offsets() const { return offsets_; }

private:
    NetworkInference<S> network_;
    VectorX<S> offsets_;
};

}  // namespace softtissue
