// SPDX-License-Identifier: MIT
/// @file
/// Minimisation without Hessians, in a metric that serves many minimisations: the fast way through a motion.
///
/// What        steps of the limited-memory BFGS method upon a factored metric, one evaluation of energy and gradient each
/// Method      full step first, then shortened by interpolation until the energy decreases (Armijo). What was learnt about the
///             curvature is forgotten after a step shortened to less than a third.
/// Stops       converged: a full step, which is applied, leaves an error of about `tolerance` at most, its largest component r / (1 - r)
///             with r the mean ratio of a step to the one before (at least 1/3; 1/2 as long as there is one step only).
///             slow_convergence: `patience` steps in a row were no smaller than one before. Here Newton's method is better,
///             started from the best point, which d holds.
/// Refuses     nothing: outcomes are in the SolveReport
/// Source      Nocedal & Wright 2006, alg. 7.5, upon the metric of Romero et al. 2020, sec. 4.2
/// Cost        a solve with the metric, an evaluation of energy and gradient, 8 flop per unknown and remembered step; no allocation
///             after the first minimisation
/// Tests       tests/unit/solver/quasi_newton_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/solver/limited_memory_bfgs.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct QuasiNewtonOptions {
    S tolerance = S(1.5e-5);  ///< [m]
    int max_steps = 30;
    int patience = 4;  ///< steps in a row that may be no smaller than one before
    int max_halvings = 20;
};

template <RealScalar S>
class QuasiNewton {
public:
    using Scalar = S;
    using Options = QuasiNewtonOptions<S>;

    /// Minimises `objective` over the free columns of `d` (3 x vertices [m]), starting from d.
    template <class ObjectiveType, class Metric, class Observer = NoObserver>
    SolveReport<S> minimise(ObjectiveType& objective, Metric& metric, Matrix3X<S>& d, const Options& options = {},
                            const Observer& observer = {}) {
        SolveReport<S> report;
        const auto ended = [&](SolveStatus status) {
            report.status = status;
            return report;
        };
        memory_.clear();
        S first_step(0), smallest = std::numeric_limits<S>::infinity();
        int steps_since_smallest = 0;
        report.energy = evaluate(objective, d, gradient_, report);
        if (!std::isfinite(report.energy) || !std::isfinite(gradient_.sum())) {
            return ended(SolveStatus::not_finite);
        }
        while (true) {
            report.residual = gradient_.size() > 0 ? gradient_.cwiseAbs().maxCoeff() : S(0);
            if (!observer(NewtonProgress<S>{report.quasi_newton_steps, report.energy, report.residual, report.step})) {
                return ended(SolveStatus::cancelled);
            }
            if (report.quasi_newton_steps == options.max_steps) {
                return ended(SolveStatus::iteration_limit);
            }
            memory_.direction_into(
                gradient_, [&](const VectorX<S>& rhs, VectorX<S>& p) { metric.solve_into(rhs, p); }, direction_);
            const S slope = gradient_.dot(direction_),
                    step = direction_.size() > 0 ? direction_.cwiseAbs().maxCoeff() : S(0);
            if (!(slope <= S(0)) || !std::isfinite(step)) {
                return ended(SolveStatus::slow_convergence);
            }
            first_step = report.quasi_newton_steps == 0 ? step : first_step;
            const bool is_last =
                step * amplification(step / first_step, report.quasi_newton_steps) <= options.tolerance;
            const S length = take_step(objective, slope, is_last, d, options, report);
            if (length == S(0)) {
                return ended(SolveStatus::line_search_stalled);
            }
            ++report.quasi_newton_steps;
            report.decrement = -slope / S(2);
            report.step = length * step;
            steps_since_smallest = report.step < smallest ? 0 : steps_since_smallest + 1;
            smallest = std::min(smallest, report.step);
            if (length < S(0.3)) {
                memory_.clear();
            }
            if (length == S(1) && is_last) {
                return ended(SolveStatus::converged);
            }
            if (steps_since_smallest == options.patience) {
                return ended(SolveStatus::slow_convergence);
            }
            direction_ *= length;
            next_gradient_.swap(gradient_);
            next_gradient_ = gradient_ - next_gradient_;
            memory_.remember(direction_, next_gradient_);
        }
    }

private:
    /// The error after a step over the step, in a sequence of steps that shrank to `decrease` of the first in `num_steps`.
    static S amplification(S decrease, int num_steps) {
        const S ratio = num_steps == 0 ? S(0.5) : std::pow(decrease, S(1) / S(num_steps));
        return ratio < S(1) ? std::max(ratio / (S(1) - ratio), S(0.5)) : std::numeric_limits<S>::infinity();
    }

    template <class ObjectiveType>
    static S evaluate(ObjectiveType& objective, const Matrix3X<S>& d, VectorX<S>& gradient, SolveReport<S>& report) {
        ++report.energy_evaluations;
        return objective.energy_and_gradient(d, gradient);
    }

    /// Returns the length of the step, 0 if none decreases the energy. Where the step is to be the last, the gradient at its end
    /// is not evaluated.
    template <class ObjectiveType>
    S take_step(ObjectiveType& objective, S slope, bool is_last, Matrix3X<S>& d, const Options& options,
                SolveReport<S>& report) {
        // the energy is a sum over many cells: differences below this are noise
        const S resolution = S(32) * std::numeric_limits<S>::epsilon() * std::abs(report.energy);
        S length(1);
        for (int halving = 0; halving <= options.max_halvings; ++halving) {
            trial_ = d;
            objective.prescribed().add_into(direction_, length, trial_);
            S energy;
            if (is_last && length == S(1)) {
                ++report.energy_evaluations;
                energy = objective.energy(trial_);
            } else {
                energy = evaluate(objective, trial_, next_gradient_, report);
            }
            const S promised = length * slope;
            if (energy <= report.energy + S(1e-4) * promised + (-promised > resolution ? S(0) : resolution)) {
                d.swap(trial_);
                report.energy = energy;
                return length;
            }
            const S interpolated = -promised / (S(2) * (energy - report.energy - promised));
            length *= std::isfinite(interpolated) ? std::clamp(interpolated, S(0.1), S(0.5)) : S(0.1);
        }
        return S(0);
    }

    LimitedMemoryBfgs<S> memory_;
    VectorX<S> gradient_, next_gradient_, direction_;
    Matrix3X<S> trial_;
};

}  // namespace softtissue
