// SPDX-License-Identifier: MIT
/// @file
/// A dense layer of a trained network with weights of half a byte, one byte where its input varies most.
///
/// What        PrincipalLinear: value of a batch of columns
/// Equation    y = W x + b = P z + (b + W m),  z = V^T (x - m),  P = W V; V orthogonal, its first columns span the directions in
///             which typical inputs vary most around their mean m. P is stored by Int8Weights for an eighth of the directions,
///             those first, by Int4Weights for the others. What typical inputs have in common costs no accuracy, and
///             roundings of P act on what varies little.
/// Shapes      x: inputs x batch, y: outputs x batch, one sample a column; typical inputs: inputs x samples
/// Valid       any x. Rounding of the stored P: half a step of its row each; products in float within n epsilon before that.
/// Refuses     fewer than two inputs, fewer than two typical inputs or all equal, weights and biases that are not finite
///             (InvalidInput). Arguments of other sizes are a caller's bug (SOFTTISSUE_ASSERT).
/// Threads     same bits for every executor
/// Cost        bytes of the weights, about 0.6 a weight, read once for up to four samples; a small product for z. The value
///             allocates nothing after reserve().
/// Tests       tests/unit/nn/principal_linear_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/completed_basis.hpp>
#include <softtissue/linalg/leading_directions.hpp>
#include <softtissue/nn/batch_product.hpp>
#include <softtissue/nn/int4_weights.hpp>
#include <softtissue/nn/int8_weights.hpp>
#include <softtissue/nn/linear.hpp>
#include <softtissue/nn/packed_rows.hpp>
#include <softtissue/nn/quantized_linear.hpp>

#include <cmath>
#include <cstddef>
#include <string>

namespace softtissue {

template <RealScalar S>
class PrincipalLinear {
public:
    using Scalar = S;
    using WeightMatrix = typename Linear<S>::WeightMatrix;

    /// What a product writes on its way, reused from one to the next.
    struct Scratch {
        MatrixX<S> z;
        DigitColumns leading, others;
    };

    /// `name` is what a refused weight is said to belong to.
    template <Executor E = SequentialExecutor>
    PrincipalLinear(ConstRef<WeightMatrix> weight, ConstRef<VectorX<S>> bias, const MatrixX<S>& typical_inputs,
                    const std::string& name, const E& executor = {})
        : num_leading_(leading_of(weight.cols(), name)),
          directions_(weight.cols(), weight.cols()),
          leading_(weight.rows(), num_leading_),
          others_(weight.rows(), weight.cols() - num_leading_),
          bias_(bias) {
        require(bias.size() == weight.rows() && bias.allFinite(), name, ": ", bias.size(), " biases, expected ",
                weight.rows(), " finite numbers");
        require(typical_inputs.rows() == inputs(), name, ": typical inputs of ", typical_inputs.rows(),
                " numbers, expected ", inputs());
        const LeadingDirections<double> leading =
            leading_directions<double>(typical_inputs.template cast<double>(), num_leading_);
        require(leading.directions.cols() >= 1, name, ": ", typical_inputs.cols(),
                " typical inputs, expected at least two that differ");
        const MatrixX<S> V = completed_basis<double>(leading.directions).template cast<S>();
        const VectorX<S> mean = leading.mean.template cast<S>();
        parameters_.resize(directions_.num_parameters());
        directions_.weight(parameters_) = V.transpose();
        directions_.bias(parameters_).setZero();
        MatrixX<S> shift(inputs(), 1);
        directions_.forward_into(parameters_, mean, shift);
        directions_.bias(parameters_) = -shift;
        set_rows(weight, V, mean, name, executor);
    }

    Index inputs() const { return directions_.inputs(); }
    Index outputs() const { return leading_.rows(); }
    Index num_leading() const { return num_leading_; }

    std::size_t num_bytes() const {
        return leading_.num_bytes() + others_.num_bytes() + sizeof(S) * size_t(bias_.size() + parameters_.size());
    }

    void reserve(Scratch& scratch, Index batch) const {
        scratch.z.resize(inputs(), batch);
        scratch.leading.reserve(num_leading_, batch);
        scratch.others.reserve(inputs() - num_leading_, batch);
    }

    /// Of at most as many samples as the scratch was reserved for.
    template <Executor E = SequentialExecutor>
    void forward_into(ConstRef<MatrixX<S>> x, Scratch& scratch, Eigen::Ref<MatrixX<S>> y,
                      const E& executor = {}) const {
        SOFTTISSUE_ASSERT(x.rows() == inputs() && y.rows() == outputs() && y.cols() == x.cols() &&
                          x.cols() <= scratch.z.cols());
        Eigen::Ref<MatrixX<S>> z = scratch.z.leftCols(x.cols());
        directions_.forward_into(parameters_, x, z, executor);
        scratch.leading.template set<S>(z.topRows(num_leading_));
        scratch.others.template set<S>(z.bottomRows(inputs() - num_leading_));
        for_each_row_range(executor, outputs(), [&](Index first, Index count) {
            y.middleRows(first, count).colwise() = bias_.segment(first, count);
            leading_.add_product(first, count, scratch.leading, y.data() + first, y.outerStride());
            others_.add_product(first, count, scratch.others, y.data() + first, y.outerStride());
        });
    }

private:
    /// An eighth or more, so that a multiple of eight is left where there is enough.
    static Index leading_of(Index inputs, const std::string& name) {
        require(inputs >= 2, name, ": ", inputs, " inputs, expected at least 2");
        const Index others = inputs * 7 / 8;
        return inputs - (others < 8 ? others : others / 8 * 8);
    }

    template <class E>
    void set_rows(ConstRef<WeightMatrix> weight, const MatrixX<S>& V, const VectorX<S>& mean, const std::string& name,
                  const E& executor) {
        for_each_row_range(executor, outputs(), [&](Index first, Index count) {
            for (Index k = 0; k < count * inputs(); ++k) {
                const S number = weight.row(first).data()[k];
                require_storable(std::isfinite(number), name, first + k / inputs(), k % inputs(), number);
            }
            MatrixX<S> P = MatrixX<S>::Zero(count, inputs()), at_mean = MatrixX<S>::Zero(count, 1);
            add_batch_product<S>(weight.row(first).data(), V, P);
            add_batch_product<S>(weight.row(first).data(), mean, at_mean);
            bias_.segment(first, count) += at_mean;
            for (Index r = 0; r < count; ++r) {
                const VectorX<S> row = P.row(r);
                leading_.set_row(first + r, row.data(), name);
                others_.set_row(first + r, row.data() + num_leading_, name);
            }
        });
    }

    Index num_leading_;
    Linear<S> directions_;
    VectorX<S> parameters_;  ///< V^T and -V^T m
    PackedRows<Int8Weights> leading_;
    PackedRows<Int4Weights> others_;
    VectorX<S> bias_;
};

}  // namespace softtissue
