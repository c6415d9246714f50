// SPDX-License-Identifier: MIT
/// @file
/// A network that predicts the residual deformation gradient of every cell from pose and shape.
///
/// What        inference of NDG: the network's outputs, nine a cell, made a gradient by the matrix exponential.
/// Equation    F_p^res = exp(Q_p), det F_p^res = exp(tr Q_p) > 0; without the exponential I + Q_p
/// Shapes      input features + shape coefficients; residuals 9 x cells, 3x3 row after row
/// Valid       every finite input. The determinant that is stored, with its rounding, is positive as long as no cell is stretched
///             and squeezed by more than about 1/epsilon at once: smallest_determinant() tells.
/// Refuses     a network whose outputs are not nine a cell, inputs of another size (InvalidInput)
/// Source      Nolte et al. 2026, eq. (14) to (16)
/// Departs     none; the rotation R_p is the caller's (see residual_gradients.hpp), or applied in the same pass over the cells
/// Cost        bytes of the weights, and one exponential a cell. Nothing is allocated after construction.
/// Tests       tests/unit/ndg/gradient_network_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/ndg/rotated_exponentials.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/network_inference.hpp>
#include <softtissue/nn/quantized_mlp.hpp>
#include <softtissue/skinning/blended_rotation.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace softtissue {

template <RealScalar S>
class GradientNetwork {
public:
    using Scalar = S;

    /// The networks must outlive this; `small` takes the place of `mlp` if it is there.
    GradientNetwork(const Mlp<S>& mlp, bool exponential, const QuantizedMlp<S>* small = nullptr)
        : network_(mlp, small), exponential_(exponential) {
        require(mlp.sizes().outputs % 9 == 0, "gradient network: ", mlp.sizes().outputs,
                " outputs, expected nine for each cell");
        outputs_.resize(9, mlp.sizes().outputs / 9);
        residuals_.resize(9, outputs_.cols());
    }

    Index num_cells() const { return residuals_.cols(); }

    /// F_p^res of one input, valid until the next call.
    template <Executor E = SequentialExecutor>
    const MatrixX<S>& predict(const VectorX<S>& input, const E& executor = {}) {
        infer(input, executor);
        if (exponential_) {
            matrix_exponentials_into<S>(outputs_, residuals_, executor);
        } else {
            residuals_ = outputs_;
            for (const int diagonal : {0, 4, 8}) {
                residuals_.row(diagonal).array() += S(1);
            }
        }
        return residuals_;
    }

    /// The same of a network with the exponential, and T_p = R_p F_p^res with the blended rotations of the bones.
    template <RealScalar T, Executor E = SequentialExecutor>
    void predict_rotated_into(const VectorX<S>& input, const BlendedRotations<T>& blended,
                              std::span<const Quaternion<T>> bones, Matrix3X<T>& targets, const E& executor = {}) {
        SOFTTISSUE_ASSERT(exponential_);
        infer(input, executor);
        rotated_exponentials_into<S, T>(outputs_, blended, bones, residuals_, targets, executor);
    }

    const MatrixX<S>& residuals() const { return residuals_; }

    /// Of the last prediction, from its rounded entries.
    S smallest_determinant() const {
        double smallest = std::numeric_limits<double>::infinity();
        for (Index c = 0; c < num_cells(); ++c) {
            const Matrix3<double> F = residuals_.col(c).reshaped(3, 3).template cast<double>();
            smallest = std::min(smallest, determinant(F));
        }
        return S(smallest);
    }

private:
    template <class E>
    void infer(const VectorX<S>& input, const E& executor) {
        require(input.size() == network_.sizes().inputs, "gradient network: ", input.size(), " inputs, expected ",
                network_.sizes().inputs);
        network_.infer_into(input, outputs_.reshaped(outputs_.size(), 1), executor);
    }

    NetworkInference<S> network_;
    bool exponential_;
    MatrixX<S> outputs_, residuals_;
};

}  // namespace softtissue
