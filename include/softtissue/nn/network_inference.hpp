// SPDX-License-Identifier: MIT
/// @file
/// A trained network with weights in whatever format, and what its inference writes to.
///
/// What        NetworkInference: the outputs of a batch, by an Mlp or by the QuantizedMlp that was made of it
/// Shapes      inputs x batch, outputs x batch, one sample a column
/// Refuses     a QuantizedMlp of other sizes; what the networks refuse (InvalidInput)
/// Cost        that of the network. Nothing is allocated after construction.
/// Tests       tests/unit/nn/network_inference_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

#include <variant>

namespace softtissue {

template <RealScalar S>
class NetworkInference {
public:
    using Scalar = S;

    /// Both must outlive this; `small` takes the place of `mlp` if it is there.
    explicit NetworkInference(const Mlp<S>& mlp, const QuantizedMlp<S>* small = nullptr, Index max_batch = 1)
        : mlp_(&mlp), small_(small) {
        if (small != nullptr) {
            const MlpSizes &full = mlp.sizes(), &sizes = small->sizes();
            require(sizes.inputs == full.inputs && sizes.hidden == full.hidden && sizes.outputs == full.outputs,
                    "network: quantized weights of ", sizes.inputs, " inputs, ", sizes.hidden.size(),
                    " hidden layers and ", sizes.outputs, " outputs, expected those of a network of ", full.inputs,
                    ", ", full.hidden.size(), " and ", full.outputs);
            scratch_ = small->make_scratch(max_batch);
        } else {
            scratch_ = mlp.make_scratch(max_batch);
        }
    }

    const MlpSizes& sizes() const { return mlp_->sizes(); }

    template <Executor E = SequentialExecutor>
    void infer_into(ConstRef<MatrixX<S>> inputs, Eigen::Ref<MatrixX<S>> outputs, const E& executor = {}) {
        if (small_ != nullptr) {
            small_->infer_into(inputs, std::get<SmallScratch>(scratch_), outputs, executor);
        } else {
            mlp_->infer_into(inputs, std::get<FullScratch>(scratch_), outputs, executor);
        }
    }

private:
    using FullScratch = typename Mlp<S>::Scratch;
    using SmallScratch = typename QuantizedMlp<S>::Scratch;

    const Mlp<S>* mlp_;
    const QuantizedMlp<S>* small_;
    std::variant<FullScratch, SmallScratch> scratch_;
};

}  // namespace softtissue
