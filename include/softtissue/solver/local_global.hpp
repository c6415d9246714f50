// SPDX-License-Identifier: MIT
/// @file
/// As-rigid-as-possible shapes by alternating rotation fits and Poisson solves (Projective Skinning).
///
/// What        minimises E(x) = sum_c V_c |F_c(x) - R_c|^2 over free vertices and rotations.
/// Equation    local  R_c = argmin |F_c(x) - R|;   global  Poisson reconstruction with the targets R_c
/// Shapes      x 3 x vertices [m], prescribed columns given, the free ones are the start
/// Valid       E never increases. Converges linearly; stops after max_iterations or when no vertex moves by more than
///             step_tolerance; not_finite, and x is the last finite shape, where numbers leave the range of the scalar.
/// Source      Komaritzan & Botsch 2018; Bouaziz et al. 2014; Nolte et al. 2026, sec. 5.2.2 (30 iterations)
/// Cost        per iteration one rotation fit per cell and one Poisson solve; allocates on the first call only
/// Tests       tests/unit/solver/local_global_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/linalg/rotation_fit.hpp>
#include <softtissue/linalg/rotation_start.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>
#include <softtissue/solver/report.hpp>

#include <cmath>

namespace softtissue {

template <RealScalar S>
struct LocalGlobalOptions {
    int max_iterations = 30;
    S step_tolerance = S(1e-6);  ///< [m]
};

template <RealScalar S>
struct [[nodiscard]] LocalGlobalReport {
    SolveStatus status = SolveStatus::iteration_limit;
    int iterations = 0;
    S step = S(0);  ///< largest motion of a vertex in the last iteration [m]
};

template <class ElementType, RealScalar S>
class LocalGlobal {
public:
    using Scalar = S;

    /// `poisson` must outlive this.
    explicit LocalGlobal(PoissonReconstruction<ElementType, Scalar>& poisson) : poisson_(&poisson) {}

    template <Executor E = SequentialExecutor>
    LocalGlobalReport<Scalar> solve_into(Matrix3X<Scalar>& x, const LocalGlobalOptions<Scalar>& options = {},
                                         const E& executor = {}) {
        LocalGlobalReport<Scalar> report;
        if (!std::isfinite(x.sum())) {
            report.status = SolveStatus::not_finite;
            return report;
        }
        while (report.iterations < options.max_iterations) {
            last_ = x;
            fit_targets(x, report.iterations == 0, executor);
            if (!poisson_->solve_finite_into(targets_, x, executor)) {
                report.status = SolveStatus::not_finite;
                break;
            }
            ++report.iterations;
            report.step = (x - last_).colwise().norm().maxCoeff();
            if (report.step <= options.step_tolerance) {
                report.status = SolveStatus::converged;
                break;
            }
        }
        return report;
    }

private:
    /// Rotations of the first iteration start anew, the others where the last one ended: a result does not depend on former ones.
    template <Executor E>
    void fit_targets(const Matrix3X<Scalar>& x, bool is_first, const E& executor) {
        constexpr int registers = rotation_fit_registers<Scalar>, N = registers * natural_lanes<Scalar>;
        using Lanes = Pack<Scalar, N>;
        quaternions_.resize(poisson_->num_cells(), 4);
        poisson_->template mapped_gradients_into<registers>(
            x, targets_, executor, [&](Index first, const Matrix3<Lanes>& F) {
                Quaternion<Lanes> q = is_first ? rotation_start(F) : load_quaternions<N>(quaternions_, first);
                const Matrix3<Lanes> R = polar_rotation(F, q);
                store_quaternions<N>(q, first, quaternions_);
                return R;
            });
    }

    PoissonReconstruction<ElementType, Scalar>* poisson_;
    Quaternions<Scalar> quaternions_;
    Matrix3X<Scalar> targets_, last_;
};

}  // namespace softtissue
