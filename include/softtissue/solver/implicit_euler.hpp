// SPDX-License-Identifier: MIT
/// @file
/// Implicit Euler with a prescribed, moving boundary, each step one minimisation.
///
/// Equation    d_{n+1} = argmin 1/(2 dt^2) |x - xt|_M^2 + sum of terms,  x = p + A d,  xt = x_n + dt v_n + dt^2 a,
///             v_{n+1} = (x_{n+1} - x_n) / dt;  p, A of the new time (a Placement), prescribed columns of d as given
/// Shapes      positions, velocities, displacement 3 x vertices [m, m/s, m]; masses vertices [kg]
/// Refuses     a time step that is not positive or whose square leaves the range of the scalar, masses that are not positive at
///             free vertices or not one per vertex, an acceleration or a state that is not finite (InvalidInput names the vertex)
/// Source      Romero et al. 2020, eq. (3)
/// Tests       tests/unit/solver/implicit_euler_test.cpp, reference dynamics in tests/reference_check
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/inertia.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <initializer_list>

namespace softtissue {

/// World positions [m] and velocities [m/s], 3 x vertices.
template <RealScalar S>
struct DynamicState {
    Matrix3X<S> positions;
    Matrix3X<S> velocities;
};

template <NewtonLinearSolver LinearSolver, Executor ExecutorType, EnergyTerm... Terms>
class ImplicitEuler {
public:
    using Scalar = typename LinearSolver::Scalar;

    /// Terms, linear solver and executor must outlive this. Starts at rest at `positions`.
    ImplicitEuler(const VectorX<Scalar>& masses, Scalar time_step, const PrescribedVertices& prescribed,
                  const Matrix3X<Scalar>& positions, LinearSolver& linear_solver, const ExecutorType& executor,
                  Terms&... terms)
        : inertia_(free_masses(masses, prescribed), time_step),
          state_{positions, Matrix3X<Scalar>::Zero(3, positions.cols())},
          linear_solver_(&linear_solver),
          objective_(prescribed, executor, inertia_, terms...) {
        inertia_.set_step(placement_, target_);
    }

    ImplicitEuler(const ImplicitEuler&) = delete;
    ImplicitEuler& operator=(const ImplicitEuler&) = delete;

    const DynamicState<Scalar>& state() const { return state_; }
    void set_state(const DynamicState<Scalar>& state) {
        require_finite(state.positions, "position");
        require_finite(state.velocities, "velocity");
        state_ = state;
    }
    Scalar time_step() const { return inertia_.time_step(); }

    /// Acceleration of every vertex that no term knows, such as gravity [m/s^2]; zero by default.
    void set_acceleration(const Vector3<Scalar>& acceleration) {
        require(acceleration.allFinite(), "implicit Euler: the acceleration is not finite");
        acceleration_ = acceleration;
    }

    /// Where the displaced vertices of the step in preparation are in the world; set before step().
    Placement<Scalar>& placement() { return placement_; }

    /// The energy of the step in preparation, for preconditioners and inspection.
    auto& objective() { return objective_; }

    /// Advances by one time step, by Newton's method. `displacement` holds the prescribed columns and is overwritten by the
    /// result; the solve starts from whichever of it and `other_starts` has the lowest energy. On failure the best accepted point
    /// is taken over.
    template <class Observer = NoObserver>
    SolveReport<Scalar> step(Matrix3X<Scalar>& displacement, const NewtonOptions<Scalar>& options = {},
                             std::initializer_list<const Matrix3X<Scalar>*> other_starts = {},
                             const Observer& observer = {}) {
        return step_by([&](auto& objective,
                           Matrix3X<Scalar>& d) { return minimise(objective, *linear_solver_, d, options, observer); },
                       displacement, other_starts);
    }

    /// The same by a method of the caller's: `method(objective, d)` minimises in place and returns a SolveReport.
    template <class Method>
    SolveReport<Scalar> step_by(const Method& method, Matrix3X<Scalar>& displacement,
                                std::initializer_list<const Matrix3X<Scalar>*> other_starts = {}) {
        const Scalar dt = time_step();
        target_ = state_.positions + dt * state_.velocities;
        target_.colwise() += dt * dt * acceleration_;
        choose_start(displacement, other_starts);
        SolveReport<Scalar> report = method(objective_, displacement);
        placement_.positions_into(displacement, next_);
        state_.velocities = (next_ - state_.positions) / dt;
        state_.positions.swap(next_);
        return report;
    }

private:
    void choose_start(Matrix3X<Scalar>& displacement, std::initializer_list<const Matrix3X<Scalar>*> other_starts) {
        if (other_starts.size() == 0) {
            return;
        }
        Scalar lowest = objective_.energy(displacement);
        const Matrix3X<Scalar>* best = &displacement;
        for (const Matrix3X<Scalar>* start : other_starts) {
            const Scalar energy = objective_.energy(*start);
            if (energy < lowest || !std::isfinite(lowest)) {
                lowest = energy;
                best = start;
            }
        }
        if (best != &displacement) {
            displacement = *best;
        }
    }

    void require_finite(const Matrix3X<Scalar>& values, const char* name) const {
        require(values.cols() == objective_.prescribed().num_vertices(), "implicit Euler: ", values.cols(),
                " columns of ", name, ", expected one for each of ", objective_.prescribed().num_vertices(),
                " vertices");
        for (Index v = 0; v < values.cols(); ++v) {
            require(values.col(v).allFinite(), "implicit Euler: ", name, " of vertex ", v, " is not finite");
        }
    }

    static VectorX<Scalar> free_masses(VectorX<Scalar> masses, const PrescribedVertices& prescribed) {
        require(masses.size() == prescribed.num_vertices(), "implicit Euler: ", masses.size(),
                " masses, expected one for each of ", prescribed.num_vertices(), " vertices");
        for (Index v = 0; v < masses.size(); ++v) {
            if (prescribed.is_prescribed(v)) {
                masses(v) = Scalar(0);
            } else {
                require(masses(v) > Scalar(0), "mass of free vertex ", v, " = ", masses(v), " kg, expected > 0");
            }
        }
        return masses;
    }

    Inertia<Scalar> inertia_;
    DynamicState<Scalar> state_;
    Vector3<Scalar> acceleration_ = Vector3<Scalar>::Zero();
    Placement<Scalar> placement_;
    Matrix3X<Scalar> target_, next_;
    LinearSolver* linear_solver_;
    Objective<ExecutorType, Inertia<Scalar>, Terms...> objective_;
};

}  // namespace softtissue
