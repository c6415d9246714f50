// SPDX-License-Identifier: MIT
/// @file
/// Layer normalisation of a network, its parameters lying with the caller.
///
/// What        LayerNorm: value and gradients of a batch of columns, each normalised by itself
/// Equation    n = (x - mean x) / sqrt(var x + epsilon),  y = w n + b  entrywise, var the biased variance;
///             dw = sum dy n,  db = sum dy over the batch;  dx = (g - mean g - n mean(g n)) / sqrt(var x + epsilon),  g = w dy
/// Shapes      x, n, y: features x batch, one sample a column; parameters: w, then b
/// Valid       any x; a constant column gives n = 0. epsilon = 1e-5, PyTorch's default.
/// Refuses     fewer than one feature (InvalidInput); arguments of other sizes are a caller's bug (SOFTTISSUE_ASSERT)
/// Source      Ba, Kiros, Hinton 2016, "Layer Normalization"
/// Cost        three passes over a column each way; sums in sixteen lanes, in an order that depends on the size alone
/// Tests       tests/unit/nn/layer_norm_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>

namespace softtissue {

namespace detail {

/// The sum of term(0) .. term(count - 1), in an order that does not depend on where the numbers lie in memory.
template <class S, class Term>
S lane_sum(Index count, const Term& term) {
    constexpr int lanes = 16;
    S sums[lanes] = {};
    Index i = 0;
    for (; i + lanes <= count; i += lanes) {
        for (int lane = 0; lane < lanes; ++lane) {
            sums[lane] += term(i + lane);
        }
    }
    for (int lane = 0; i < count; ++i, ++lane) {
        sums[lane] += term(i);
    }
    for (int half = lanes / 2; half > 0; half /= 2) {
        for (int lane = 0; lane < half; ++lane) {
            sums[lane] += sums[lane + half];
        }
    }
    return sums[0];
}

}  // namespace detail

template <RealScalar S>
class LayerNorm {
public:
    using Scalar = S;
    static constexpr S epsilon = S(1e-5);

    explicit LayerNorm(Index features) : features_(features) {
        require(features >= 1, "layer normalisation of ", features, " features, expected at least one");
    }

    Index features() const { return features_; }
    Index num_parameters() const { return 2 * features_; }

    /// y = w n + b; `normalized` takes n and `inverse_deviations` 1 / sqrt(var + epsilon) of each column, for
    /// gradient_into(). x, normalized and y may be the same memory.
    void forward_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> x, Eigen::Ref<MatrixX<S>> normalized,
                      Eigen::Ref<VectorX<S>> inverse_deviations, Eigen::Ref<MatrixX<S>> y) const {
        SOFTTISSUE_ASSERT(parameters.size() == num_parameters() && x.rows() == features_ && y.rows() == features_ &&
                          normalized.rows() == features_ && y.cols() == x.cols() && normalized.cols() == x.cols() &&
                          inverse_deviations.size() == x.cols());
        const S* const w = parameters.data();
        const S* const b = w + features_;
        for (Index sample = 0; sample < x.cols(); ++sample) {
            const S* const from = x.col(sample).data();
            S* const n = normalized.col(sample).data();
            S* const to = y.col(sample).data();
            const S mean = detail::lane_sum<S>(features_, [from](Index i) { return from[i]; }) / S(features_);
            const S variance = detail::lane_sum<S>(features_,
                                                   [from, mean](Index i) {
                                                       const S centred = from[i] - mean;
                                                       return centred * centred;
                                                   }) /
                               S(features_);
            const S inverse_deviation = S(1) / std::sqrt(variance + epsilon);
            inverse_deviations(sample) = inverse_deviation;
            for (Index i = 0; i < features_; ++i) {
                const S value = (from[i] - mean) * inverse_deviation;
                n[i] = value;
                to[i] = w[i] * value + b[i];
            }
        }
    }

    /// The gradient by the parameters, of a function whose gradient by y is `gradients`, which becomes that by x.
    void backward_into(ConstRef<VectorX<S>> parameters, ConstRef<MatrixX<S>> normalized,
                       ConstRef<VectorX<S>> inverse_deviations, Eigen::Ref<MatrixX<S>> gradients,
                       Eigen::Ref<VectorX<S>> parameter_gradient) const {
        SOFTTISSUE_ASSERT(parameters.size() == num_parameters() && normalized.rows() == features_ &&
                          gradients.rows() == features_ && gradients.cols() == normalized.cols() &&
                          inverse_deviations.size() == normalized.cols() &&
                          parameter_gradient.size() == num_parameters());
        const S* const w = parameters.data();
        S* const dw = parameter_gradient.data();
        S* const db = dw + features_;
        parameter_gradient.setZero();
        for (Index sample = 0; sample < normalized.cols(); ++sample) {
            const S* const n = normalized.col(sample).data();
            S* const d = gradients.col(sample).data();
            for (Index i = 0; i < features_; ++i) {
                dw[i] += d[i] * n[i];
                db[i] += d[i];
                d[i] *= w[i];
            }
            const S mean = detail::lane_sum<S>(features_, [d](Index i) { return d[i]; }) / S(features_);
            const S slope = detail::lane_sum<S>(features_, [d, n](Index i) { return d[i] * n[i]; }) / S(features_);
            const S scale = inverse_deviations(sample);
            for (Index i = 0; i < features_; ++i) {
                d[i] = scale * (d[i] - mean - n[i] * slope);
            }
        }
    }

private:
    Index features_;
};

}  // namespace softtissue
