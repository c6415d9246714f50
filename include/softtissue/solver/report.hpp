// SPDX-License-Identifier: MIT
/// @file
/// How a solve ended: a value, never an exception.
///
/// What        status, counts, energy and residual of a Newton solve; the state is left at the best accepted point.
///             NewtonProgress: what is told on the way.
/// Units       energy J, residual N (largest gradient component on free vertices), step m (largest component)
/// Tests       tests/unit/solver/report_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

namespace softtissue {

enum class SolveStatus {
    converged,            ///< a stated tolerance is met; that of the step counts only where the Hessian is positive definite
    precision_limit,      ///< no further decrease can be resolved in this precision; as good as it gets
    iteration_limit,      ///< the allowed iterations are spent
    slow_convergence,     ///< steps without Hessians gain too little here; Newton's method is to go on
    saddle_point,         ///< the gradient vanishes but the Hessian is indefinite: not a minimum
    line_search_stalled,  ///< no acceptable step along a descent direction
    linear_solver_failed, ///< even the filtered Hessian could not be solved
    not_finite,           ///< energy or gradient at the start is not finite
    cancelled,            ///< the observer asked to stop
};

/// The status in words.
constexpr const char* to_string(SolveStatus status) {
    switch (status) {
        case SolveStatus::converged: return "converged";
        case SolveStatus::precision_limit: return "precision limit reached";
        case SolveStatus::iteration_limit: return "iteration limit reached";
        case SolveStatus::slow_convergence: return "converges slowly";
        case SolveStatus::saddle_point: return "stopped at a saddle point";
        case SolveStatus::line_search_stalled: return "line search stalled";
        case SolveStatus::linear_solver_failed: return "linear solver failed";
        case SolveStatus::not_finite: return "energy is not finite at the start";
        case SolveStatus::cancelled: return "cancelled";
    }
    return "unknown";
}

template <RealScalar S>
struct [[nodiscard]] SolveReport {
    SolveStatus status = SolveStatus::iteration_limit;
    int iterations = 0;           ///< Newton iterations: linear systems solved and steps taken
    int filtered_iterations = 0;  ///< of these, with a filtered Hessian
    int indefinite_hessians = 0;  ///< exact Hessians that were tried and not positive definite
    int quasi_newton_steps = 0;   ///< steps before or between the iterations, with a Hessian of before
    int energy_evaluations = 0;
    int linear_iterations = 0;    ///< conjugate-gradient iterations; 0 for direct solvers
    S energy = S(0);
    S residual = S(0);
    S decrement = S(0);           ///< decrease that the last step promised [J]
    S step = S(0);                ///< largest component of the last step

    /// The state is a minimum as far as tolerances and precision tell.
    bool succeeded() const { return status == SolveStatus::converged || status == SolveStatus::precision_limit; }
};

/// What an observer sees before each iteration; it returns false to cancel.
template <RealScalar S>
struct NewtonProgress {
    int iteration;
    S energy;
    S residual;
    S step;
};

/// Watches nothing and never cancels.
struct NoObserver {
    template <class Progress>
    bool operator()(const Progress&) const {
        return true;
    }
};

}  // namespace softtissue
