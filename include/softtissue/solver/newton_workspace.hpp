// SPDX-License-Identifier: MIT
/// @file
/// The memory of Newton's method, for those who solve again and again.
///
/// What        minimise() of newton.hpp makes one for each solve, or takes one: what is large enough is not allocated anew.
///             Nothing of one solve is left for the next but the room.
/// Threads     one solve at a time
/// Tests       tests/unit/solver/newton_workspace_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/solver/limited_memory_bfgs.hpp>

namespace softtissue {

template <RealScalar S>
struct NewtonWorkspace {
    VectorX<S> gradient, last_gradient, trial_gradient, rhs, direction;
    Matrix3X<S> trial;
    LimitedMemoryBfgs<S> memory;
};

}  // namespace softtissue
