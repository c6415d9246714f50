// SPDX-License-Identifier: MIT
/// @file
/// A fixed linear map behind a network: few coefficients in, many numbers out.
///
/// What        LinearDecoder, for instance of a PCA; fold_decoder(), which makes it part of the network's last layer.
/// Equation    y = D c + b. A network that ends in c = W h + v is, with the decoder, one that ends in y = (D W) h + (D v + b)
/// Shapes      D outputs x coefficients, b outputs
/// Valid       folding changes rounding only. It makes the network smaller where its last hidden layer is narrower than
///             the decoder, and lets everything be trained further.
/// Refuses     a network with another number of outputs than the decoder has coefficients (InvalidInput)
/// Source      Han et al. 2024, as Nolte et al. 2026 use it in sec. 5.2.1
/// Tests       tests/unit/ndg/linear_decoder_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/mlp.hpp>

namespace softtissue {

template <RealScalar S>
struct LinearDecoder {
    MatrixX<S> weight;  // D
    VectorX<S> bias;    // b
};

/// The network and its decoder as one network.
template <RealScalar S>
Mlp<S> fold_decoder(const Mlp<S>& mlp, const LinearDecoder<S>& decoder) {
    MlpSizes sizes = mlp.sizes();
    require(decoder.weight.cols() == sizes.outputs && decoder.bias.size() == decoder.weight.rows(),
            "linear decoder: ", decoder.weight.cols(), " coefficients and ", decoder.bias.size(), " biases, expected ",
            sizes.outputs, " and ", decoder.weight.rows());
    sizes.outputs = decoder.weight.rows();
    Mlp<S> folded(sizes);
    const Index last = mlp.layers().num_hidden();
    const Index shared = mlp.parameters().size() - mlp.layers().linear(last).num_parameters();
    folded.parameters().head(shared) = mlp.parameters().head(shared);
    folded.weight(last).noalias() = decoder.weight * mlp.weight(last);
    folded.bias(last) = decoder.bias;
    folded.bias(last).noalias() += decoder.weight * mlp.bias(last);
    return folded;
}

}  // namespace softtissue
