// SPDX-License-Identifier: MIT
/// @file
/// What solves Newton's linear systems.
///
/// What        solve(H, rhs, relative_tolerance, p, executor): p with |H p - rhs| <= relative_tolerance |rhs|, in the norm
///             of the residual or one closer to the energy's, or the answer that H is not positive definite (then p is
///             unspecified, and Newton asks again with a filtered H). An iterative solver that runs out of iterations hands
///             back its best p, which is still a direction of descent.
/// Tests       tests/unit/solver/direct_solver_test.cpp, tests/unit/solver/metric_cg_test.cpp,
///             tests/unit/solver/gauss_seidel_cg_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <concepts>

namespace softtissue {

struct LinearSolveResult {
    bool is_positive_definite;
    int iterations;
};

template <class T>
concept NewtonLinearSolver = requires(T& solver, const BlockMatrix<typename T::Scalar>& H,
                                      const VectorX<typename T::Scalar>& rhs, typename T::Scalar relative_tolerance,
                                      VectorX<typename T::Scalar>& p, const SequentialExecutor& executor) {
    { solver.solve(H, rhs, relative_tolerance, p, executor) } -> std::same_as<LinearSolveResult>;
};

/// solve_again(rhs, p): the system of the last solve() with another right-hand side, for a fraction of its cost.
template <class T>
concept FactorKeepingSolver = NewtonLinearSolver<T> &&
    requires(T& solver, const VectorX<typename T::Scalar>& rhs, VectorX<typename T::Scalar>& p) {
    solver.solve_again(rhs, p);
};

}  // namespace softtissue
