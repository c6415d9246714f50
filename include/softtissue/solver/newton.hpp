// SPDX-License-Identifier: MIT
/// @file
/// Newton's method with a line search, exact where the Hessian is positive definite, filtered where not.
///
/// What        minimises an Objective over the free vertices, in place.
/// Method      each iteration tries the exact Hessian first; if it is indefinite, the one filtered per stencil. Far from the
///             minimum the trial is wasted: after a step longer than far_step, and filtered_after_failure times after an
///             indefinite Hessian, it is left out. Full step first, shortened until the energy decreases, lengthened where it
///             falls like an exponential (line_search.hpp). Never increases the energy beyond its round-off.
///             Between two iterations up to quasi_newton_steps steps reuse the last Hessian, corrected by what recent steps told
///             about the curvature (limited_memory_bfgs.hpp), while each gains a twentieth of the iteration's decrease.
/// Stops       step_tolerance: largest component of an exact Newton step, which is then applied (error ~ its square);
///             decrement_tolerance: decrease that an exact Newton step, then applied, promises; gradient_tolerance: largest
///             gradient component; or a status that says why not. A filtered step never ends a solve as converged. Where the last
///             step is lost in the rounding of the energy: precision_limit.
/// Cost        no allocation after the first iteration, nor in any with the NewtonWorkspace of a former solve
/// Refuses     nothing: outcomes are in the SolveReport.
/// Source      Nocedal & Wright 2006, alg. 3.2; Chen et al. 2024 (absolute filter), 2024b (adaptive filter); Nolte et al. 2026, sec. 3.2
/// Tests       tests/unit/solver/newton_test.cpp, tests/scenario/static_solve_test.cpp
#pragma once

#include <softtissue/core/config.hpp>  // refuses -ffinite-math-only
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/solver/line_search.hpp>
#include <softtissue/solver/newton_workspace.hpp>
#include <softtissue/solver/report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct NewtonOptions {
    int max_iterations = 100;
    S step_tolerance = S(1e-9);    ///< [m]
    S gradient_tolerance = S(0);   ///< [N]; 0: not used
    S decrement_tolerance = S(0);  ///< g^T H^-1 g / 2 [J]; 0: not used
    S linear_tolerance = S(1e-3);  ///< asked of iterative linear solvers; a decrement is short by about its square
    PsdFilter filter = PsdFilter::absolute;
    /// Clamp in place of `filter` after a step whose decrease the filtered model predicted within one per cent.
    bool adapts_filter = false;
    S far_step = std::numeric_limits<S>::infinity();  ///< [m]; infinity: the exact Hessian is always tried
    int filtered_after_failure = 0;
    int max_halvings = LineSearchOptions{}.max_halvings;    ///< of a step that does not decrease the energy
    int max_doublings = LineSearchOptions{}.max_doublings;  ///< of one that decreases it like an exponential
    int quasi_newton_steps = 0;  ///< after each iteration, where the linear solver keeps its factor
};

namespace detail {

/// One Newton solve; see minimise().
template <class ObjectiveType, class LinearSolver, class Observer>
class NewtonIteration {
public:
    using Scalar = typename ObjectiveType::Scalar;

    NewtonIteration(ObjectiveType& objective, LinearSolver& linear_solver, Matrix3X<Scalar>& d,
                    const NewtonOptions<Scalar>& options, const Observer& observer, NewtonWorkspace<Scalar>& workspace)
        : objective_(objective),
          linear_solver_(linear_solver),
          d_(d),
          options_(options),
          observer_(observer),
          w_(workspace) {
        w_.memory.clear();
    }

    SolveReport<Scalar> run() {
        report_.energy = energy_at(d_, has_both);
        refresh_gradient();
        w_.last_gradient = w_.trial_gradient = w_.gradient;  // room for the next ones
        if (!std::isfinite(report_.energy) || !std::isfinite(report_.residual)) {
            return ended(SolveStatus::not_finite);
        }
        while (true) {
            if (report_.residual <= options_.gradient_tolerance) {
                return ended(SolveStatus::converged);
            }
            if (!observer_(
                    NewtonProgress<Scalar>{report_.iterations, report_.energy, report_.residual, report_.step})) {
                return ended(SolveStatus::cancelled);
            }
            if (report_.iterations == options_.max_iterations) {
                return ended(SolveStatus::iteration_limit);
            }
            if (!find_direction()) {
                return ended(SolveStatus::linear_solver_failed);
            }
            const Scalar last_residual = report_.residual;
            const Scalar last_energy = report_.energy;
            const Scalar step = w_.direction.cwiseAbs().maxCoeff();
            report_.decrement = -w_.gradient.dot(w_.direction) / Scalar(2);
            const LineSearchOutcome outcome = take_step();
            const bool is_small = step <= options_.step_tolerance || report_.decrement <= options_.decrement_tolerance;
            if (outcome == LineSearchOutcome::none) {
                // the step that would end the solve is lost in the rounding of the energy
                const bool is_there = is_small && hessian_ == HessianKind::exact;
                return ended(is_there ? SolveStatus::precision_limit : SolveStatus::line_search_stalled);
            }
            refresh_gradient();
            remember_step();
            if (is_small && hessian_ == HessianKind::exact) {
                return ended(SolveStatus::converged);
            }
            if (step <= options_.step_tolerance && hessian_ == HessianKind::indefinite) {
                return ended(SolveStatus::saddle_point);
            }
            if (outcome == LineSearchOutcome::below_resolution && !(report_.residual < last_residual)) {
                return ended(SolveStatus::precision_limit);
            }
            plan_next(is_small);
            if constexpr (FactorKeepingSolver<LinearSolver>) {
                take_quasi_newton_steps(Scalar(0.05) * (last_energy - report_.energy));
            }
        }
    }

private:
    /// Of the last direction: filtered without a trial of the exact one, or after that was found indefinite.
    enum class HessianKind { exact, indefinite, filtered };
    /// Energy and gradient cost less together than one after the other.
    static constexpr bool has_both = requires(ObjectiveType & f, Matrix3X<Scalar>& d, VectorX<Scalar>& gradient) {
        f.energy_and_gradient(d, gradient);
    };

    SolveReport<Scalar> ended(SolveStatus status) {
        report_.status = status;
        return report_;
    }

    Scalar energy_at(const Matrix3X<Scalar>& d, bool with_gradient) {
        ++report_.energy_evaluations;
        if constexpr (has_both) {
            if (with_gradient) {
                return objective_.energy_and_gradient(d, w_.trial_gradient);
            }
        }
        return objective_.energy(d);
    }

    /// At d.
    void refresh_gradient() {
        w_.last_gradient.swap(w_.gradient);
        if (has_trial_gradient_) {
            w_.gradient.swap(w_.trial_gradient);
        } else {
            w_.gradient = objective_.gradient(d_);
        }
        // maxCoeff skips NaN on some paths; the sum does not
        report_.residual = std::isfinite(w_.gradient.sum()) && w_.gradient.size() > 0
                               ? w_.gradient.cwiseAbs().maxCoeff()
                               : w_.gradient.sum();
    }

    bool find_direction() {
        w_.rhs = -w_.gradient;
        hessian_ = HessianKind::filtered;
        if (filtered_ahead_ == 0) {
            hessian_ = solve_with(PsdFilter::none) ? HessianKind::exact : HessianKind::indefinite;
            filtered_ahead_ = hessian_ == HessianKind::exact ? 0 : options_.filtered_after_failure + 1;
            report_.indefinite_hessians += hessian_ == HessianKind::exact ? 0 : 1;
        }
        if (hessian_ != HessianKind::exact) {
            --filtered_ahead_;
            ++report_.filtered_iterations;
            if (!solve_with(filter_)) {
                return false;
            }
        }
        ++report_.iterations;
        return true;
    }

    /// Which Hessian comes next; a small step calls for the exact one, which alone can end the solve.
    void plan_next(bool is_small) {
        if (is_small) {
            filtered_ahead_ = 0;
        } else if (report_.step > options_.far_step) {
            filtered_ahead_ = std::max(filtered_ahead_, 1);
        }
        if (options_.adapts_filter && hessian_ != HessianKind::exact) {
            filter_ = std::abs(predicted_ratio_ - Scalar(1)) <= Scalar(0.01) ? PsdFilter::clamp : options_.filter;
        }
    }

    bool solve_with(PsdFilter filter) {
        const LinearSolveResult result = linear_solver_.solve(
            objective_.hessian(d_, filter), w_.rhs, options_.linear_tolerance, w_.direction, objective_.executor());
        report_.linear_iterations += result.iterations;
        return result.is_positive_definite && std::isfinite(w_.direction.sum()) &&
               w_.gradient.dot(w_.direction) <= Scalar(0);
    }

    void remember_step() {
        if (options_.quasi_newton_steps > 0) {
            w_.direction *= length_;
            w_.last_gradient = w_.gradient - w_.last_gradient;
            w_.memory.remember(w_.direction, w_.last_gradient);
        }
    }

    /// Ends early where a step gains less than asked, and with the exact Hessian next where the decrement's tolerance is met.
    void take_quasi_newton_steps(Scalar least_decrease) {
        const auto solve_again = [&](const VectorX<Scalar>& rhs, VectorX<Scalar>& p) {
            linear_solver_.solve_again(rhs, p);
        };
        Scalar decrease = least_decrease;
        for (int k = 0; k < options_.quasi_newton_steps && decrease >= least_decrease; ++k) {
            w_.memory.direction_into(w_.gradient, solve_again, w_.direction);
            const Scalar promised = -w_.gradient.dot(w_.direction) / Scalar(2);
            if (promised <= options_.decrement_tolerance) {
                filtered_ahead_ = 0;
                return;
            }
            decrease = report_.energy;
            if (take_step() != LineSearchOutcome::decreased) {
                return;
            }
            decrease -= report_.energy;
            ++report_.quasi_newton_steps;
            refresh_gradient();
            remember_step();
        }
    }

    void set_trial(Scalar length) {
        w_.trial = d_;
        objective_.prescribed().add_into(w_.direction, length, w_.trial);
    }

    LineSearchOutcome take_step() {
        Scalar tried(0);
        const auto trial_energy = [&](Scalar length) {
            set_trial(tried = length);
            return energy_at(w_.trial, length == Scalar(1));
        };
        const LineSearchResult<Scalar> found =
            search_line(trial_energy, report_.energy, w_.gradient.dot(w_.direction),
                        {.max_halvings = options_.max_halvings, .max_doublings = options_.max_doublings});
        if (found.outcome == LineSearchOutcome::none) {
            return found.outcome;
        }
        if (tried != found.length) {
            set_trial(found.length);
        }
        d_.swap(w_.trial);
        has_trial_gradient_ = has_both && found.length == Scalar(1);
        predicted_ratio_ = found.predicted_ratio;
        report_.energy = found.energy;
        length_ = found.length;
        report_.step = length_ * w_.direction.cwiseAbs().maxCoeff();
        return found.outcome;
    }

    ObjectiveType& objective_;
    LinearSolver& linear_solver_;
    Matrix3X<Scalar>& d_;
    const NewtonOptions<Scalar>& options_;
    const Observer& observer_;
    SolveReport<Scalar> report_;
    PsdFilter filter_ = options_.filter;
    HessianKind hessian_ = HessianKind::exact;
    int filtered_ahead_ = std::isfinite(options_.far_step) ? 1 : 0;
    Scalar predicted_ratio_ = Scalar(0);  // actual over predicted decrease of the last step
    Scalar length_ = Scalar(0);           // of the last step, in directions
    bool has_trial_gradient_ = has_both;  // at d_
    NewtonWorkspace<Scalar>& w_;
};

}  // namespace detail

/// Minimises `objective` over the free columns of `d`, 3 x vertices [m], starting from d; the prescribed columns are given.
/// d is left at the best accepted point whatever the status.
template <class ObjectiveType, NewtonLinearSolver LinearSolver, class Observer>
SolveReport<typename ObjectiveType::Scalar> minimise(ObjectiveType& objective, LinearSolver& linear_solver,
                                                     Matrix3X<typename ObjectiveType::Scalar>& d,
                                                     const NewtonOptions<typename ObjectiveType::Scalar>& options,
                                                     const Observer& observer,
                                                     NewtonWorkspace<typename ObjectiveType::Scalar>& workspace) {
    using Iteration = detail::NewtonIteration<ObjectiveType, LinearSolver, Observer>;
    return Iteration(objective, linear_solver, d, options, observer, workspace).run();
}

/// The same in memory of its own.
template <class ObjectiveType, NewtonLinearSolver LinearSolver, class Observer = NoObserver>
SolveReport<typename ObjectiveType::Scalar> minimise(ObjectiveType& objective, LinearSolver& linear_solver,
                                                     Matrix3X<typename ObjectiveType::Scalar>& d,
                                                     const NewtonOptions<typename ObjectiveType::Scalar>& options = {},
                                                     const Observer& observer = {}) {
    NewtonWorkspace<typename ObjectiveType::Scalar> workspace;
    return minimise(objective, linear_solver, d, options, observer, workspace);
}

}  // namespace softtissue
