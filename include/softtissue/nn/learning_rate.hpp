// SPDX-License-Identifier: MIT
/// @file
/// How the learning rate changes while a network is trained.
///
/// What        the factor of the learning rate at a step: a straight line up from zero, then half a cosine down
/// Equation    (k + 1) / w for k < w;  then f + (1 - f) (1 + cos(pi (k - w) / (n - w))) / 2 for w <= k < n
/// Shapes      step k = 0 .. n - 1, w warm-up steps, f the fraction that is left at the end; f = 1 is constant
/// Source      Loshchilov, Hutter 2017, "SGDR", without restarts
/// Refuses     w < 0, f < 0, numbers that are not finite (InvalidInput)
/// Tests       tests/unit/nn/learning_rate_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <cmath>
#include <numbers>

namespace softtissue {

struct LearningRateSchedule {
    Index warm_up_steps = 0;
    double final_fraction = 1;

    void validate() const {
        require(warm_up_steps >= 0, "learning rate: warm_up_steps = ", warm_up_steps, ", expected >= 0");
        require(final_fraction >= 0 && std::isfinite(final_fraction),
                "learning rate: final_fraction = ", final_fraction, ", expected >= 0");
    }

    /// The factor at step 0 .. num_steps - 1.
    double factor(Index step, Index num_steps) const {
        if (step < warm_up_steps) {
            return double(step + 1) / double(warm_up_steps);
        }
        const double progress = double(step - warm_up_steps) / double(num_steps - warm_up_steps);
        return final_fraction + (1 - final_fraction) * (1 + std::cos(std::numbers::pi * progress)) / 2;
    }
};

}  // namespace softtissue
