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

namespace softtissue {

template <RealScalar S>
class VertexNetwork {
public:
    using Scalar = S;

    /// `mlp` must outlive this.
    explicit VertexNetwork(const Mlp<S>& mlp)
        : mlp_(&mlp), scratch_(mlp.make_scratch(1)), offsets_(mlp.sizes().outputs) {
        require(mlp.sizes().outputs % 3 == 0, "vertex network: ", mlp.sizes().outputs,
                " outputs, expected three for each free vertex");
    }

    Index num_vertices() const { return offsets_.size() / 3; }

    /// d_v of one input, valid until the next call.
    template <Executor E = SequentialExecutor>
    const VectorX<S>& predict(const VectorX<S>& input, const E& executor = {}) {
        require(input.size() == mlp_->sizes().inputs, "vertex network: ", input.size(), " inputs, expected ",
                mlp_->sizes().inputs);
        mlp_->infer_into(input, scratch_, offsets_, executor);
        return offsets_;
    }

    const VectorX<S>& offsets() const { return offsets_; }

private:
    const Mlp<S>* mlp_;
    typename Mlp<S>::Scratch scratch_;
    VectorX<S> offsets_;
};

}  // namespace softtissue
