// SPDX-License-Identifier: MIT
/// @file
/// Where a training stands: what it needs to go on as if it had never stopped.
///
/// What        parameters, moments, the best parameters so far, and what has been counted; a checkpoint is a copy of this
/// Losses      means over samples; in double whatever the scalar
/// Tests       tests/unit/nn/training_state_test.cpp, tests/unit/nn/train_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <limits>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct TrainingState {
    VectorX<S> parameters;
    VectorX<S> first_moment, second_moment;  ///< of the gradient (AdamW)
    VectorX<S> best_parameters;              ///< of the smallest validation loss; the first ones before there is any

    Index step = 0;       ///< updates done
    Index best_step = 0;  ///< updates done when the parameters were best
    double best_loss = std::numeric_limits<double>::infinity();

    std::vector<double> training_losses, validation_losses;  ///< one an epoch
    double epoch_loss_sum = 0;                               ///< over the samples seen in the current epoch
    Index epoch_samples = 0;

    TrainingState() = default;

    /// Before the first step.
    explicit TrainingState(VectorX<S> start)
        : parameters(std::move(start)),
          first_moment(VectorX<S>::Zero(parameters.size())),
          second_moment(VectorX<S>::Zero(parameters.size())),
          best_parameters(parameters) {}
};

}  // namespace softtissue
