// SPDX-License-Identifier: MIT
/// @file
/// Newton's linear system by conjugate gradients, preconditioned with a metric that is kept for a whole motion.
///
/// What        NewtonLinearSolver: the Hessian enters through products only
/// Metric      solve_into(r, z): z = the product of the metric's inverse with r (solver/scalar_metric.hpp)
/// Source      Nocedal & Wright 2006, alg. 5.3
/// Departs     stops at negative curvature and reports an indefinite Hessian; the same where a number leaves the range of the scalar
/// Tests       tests/unit/solver/metric_cg_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <limits>

namespace softtissue {

template <class Metric>
class MetricCg {
public:
    using Scalar = typename Metric::Scalar;

    /// More iterations than this on one system mean that the metric no longer fits.
    static constexpr int max_iterations = 400;

    /// The metric must outlive this.
    explicit MetricCg(Metric& metric) : metric_(&metric) {}

    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<Scalar>& H, const VectorX<Scalar>& rhs, Scalar relative_tolerance,
                            VectorX<Scalar>& p, const E& executor) {
        p.setZero(rhs.size());
        residual_ = rhs;
        const Scalar target = relative_tolerance * rhs.norm();
        metric_->solve_into(residual_, z_);
        direction_ = z_;
        Scalar rz = residual_.dot(z_);
        int iteration = 0;
        // written so that numbers that are not finite do not pass for a solution
        if (!(target <= std::numeric_limits<Scalar>::max())) {
            return {.is_positive_definite = false, .iterations = 0};
        }
        while (iteration < max_iterations && !(residual_.norm() <= target)) {
            ++iteration;
            H.multiply_into(direction_, product_, executor);
            const Scalar curvature = direction_.dot(product_);
            if (!(curvature > Scalar(0))) {
                return {.is_positive_definite = false, .iterations = iteration};
            }
            const Scalar alpha = rz / curvature;
            p += alpha * direction_;
            residual_ -= alpha * product_;
            metric_->solve_into(residual_, z_);
            const Scalar rz_next = residual_.dot(z_);
            direction_ = z_ + (rz_next / rz) * direction_;
            rz = rz_next;
        }
        return {.is_positive_definite = true, .iterations = iteration};
    }

private:
    Metric* metric_;
    VectorX<Scalar> residual_, z_, direction_, product_;
};

}  // namespace softtissue
