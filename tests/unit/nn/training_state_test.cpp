// SPDX-License-Identifier: MIT
#include <softtissue/nn/training_state.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("before the first step nothing is known but the start", S, float, double) {
    const VectorX<S> start = VectorX<S>::LinSpaced(5, 1, 2);
    const TrainingState<S> state(start);
    CHECK(state.parameters == start);
    CHECK(state.best_parameters == start);
    CHECK(state.first_moment == VectorX<S>::Zero(5));
    CHECK(state.second_moment == VectorX<S>::Zero(5));
    CHECK(state.step == 0);
    CHECK(state.best_loss > 1e300);
    CHECK(state.training_losses.empty());
}
