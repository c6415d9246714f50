// SPDX-License-Identifier: MIT
/// @file
/// Static equilibrium after a large motion of the prescribed vertices: in one increment if possible, in more if needed.
///
/// What        predictor and corrector: the free vertices first follow the boundary linearly (one solve with the Hessian of the
///             last equilibrium), then Newton. An increment that fails is halved, one that succeeds easily is doubled.
/// Equation    H_ff dd_f = -H_fp dd_p  (H_fp dd_p by a difference of gradients)
/// Shapes      d, target 3 x vertices [m]; only the prescribed columns of `target` matter
/// Why         a boundary that jumps alone strains the cells beside it without bound, and exponential laws overflow
/// Source      Allgower & Georg 1990, ch. 2 (Euler predictor, Newton corrector)
/// Tests       tests/unit/solver/continuation_test.cpp, reference statics in tests/reference_check
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/solver/newton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct ContinuationOptions {
    NewtonOptions<S> newton = {};
    int iterations_per_increment = 30;  ///< an increment that needs more is halved instead
    int max_halvings = 12;              ///< smallest increment: 2^-max_halvings of the motion
};

namespace detail {

/// Moves the free columns of `moved`, whose prescribed columns are new, as the linearisation at the equilibrium `d` says.
template <class ObjectiveType, class LinearSolver>
void predict(ObjectiveType& objective, LinearSolver& linear_solver, const Matrix3X<typename ObjectiveType::Scalar>& d,
             const NewtonOptions<typename ObjectiveType::Scalar>& options, Matrix3X<typename ObjectiveType::Scalar>& moved) {
    using Scalar = typename ObjectiveType::Scalar;
    using std::sqrt;
    const Matrix3X<Scalar> motion = moved - d;
    const Scalar size = motion.cwiseAbs().maxCoeff();
    if (!(size > Scalar(0))) {
        return;
    }
    // step of a difference quotient: rounding and curvature weigh the same for a motion of the size of positions
    const Scalar step = sqrt(std::numeric_limits<Scalar>::epsilon()) * std::max(d.cwiseAbs().maxCoeff(), size) / size;
    const VectorX<Scalar> before = objective.gradient(d);
    const VectorX<Scalar> rhs = (before - objective.gradient(d + step * motion)) / step;
    VectorX<Scalar> following;
    const LinearSolveResult result = linear_solver.solve(objective.hessian(d, options.filter), rhs, options.linear_tolerance,
                                                         following, objective.executor());
    if (!result.is_positive_definite || !std::isfinite(following.sum())) {
        return;
    }
    Matrix3X<Scalar> predicted = moved;
    objective.prescribed().add_into(following, Scalar(1), predicted);
    if (objective.energy(predicted) < objective.energy(moved)) {
        moved.swap(predicted);
    }
}

}  // namespace detail

/// From the equilibrium `d` to that with the prescribed columns of `target`. d is left at the last equilibrium reached (on
/// success that of `target`); the report counts the iterations of all increments.
template <class ObjectiveType, NewtonLinearSolver LinearSolver, class Observer = NoObserver>
SolveReport<typename ObjectiveType::Scalar> follow_boundary(
    ObjectiveType& objective, LinearSolver& linear_solver, Matrix3X<typename ObjectiveType::Scalar>& d,
    const Matrix3X<typename ObjectiveType::Scalar>& target,
    const ContinuationOptions<typename ObjectiveType::Scalar>& options = {}, const Observer& observer = {}) {
    using Scalar = typename ObjectiveType::Scalar;
    Matrix3X<Scalar> motion = Matrix3X<Scalar>::Zero(3, d.cols());
    for (Index v = 0; v < d.cols(); ++v) {
        if (objective.prescribed().is_prescribed(v)) {
            motion.col(v) = target.col(v) - d.col(v);
        }
    }
    NewtonOptions<Scalar> newton = options.newton;
    newton.max_iterations = options.iterations_per_increment;
    const Scalar smallest = std::ldexp(Scalar(1), -options.max_halvings);
    Scalar remaining(1);
    Scalar increment(1);
    SolveReport<Scalar> total;
    while (remaining > Scalar(0)) {
        Matrix3X<Scalar> moved = d + increment * motion;
        detail::predict(objective, linear_solver, d, newton, moved);
        if (increment <= smallest) {
            newton.max_iterations = options.newton.max_iterations;
        }
        SolveReport<Scalar> report = minimise(objective, linear_solver, moved, newton, observer);
        report.iterations += total.iterations;
        report.filtered_iterations += total.filtered_iterations;
        report.indefinite_hessians += total.indefinite_hessians;
        report.energy_evaluations += total.energy_evaluations;
        report.linear_iterations += total.linear_iterations;
        total = report;
        if (report.succeeded()) {
            d.swap(moved);
            remaining -= increment;
            increment = std::min(Scalar(2) * increment, remaining);
        } else if (report.status == SolveStatus::cancelled || increment <= smallest) {
            return total;
        } else {
            increment *= Scalar(0.5);
        }
    }
    return total;
}

}  // namespace softtissue
