// SPDX-License-Identifier: MIT
/// @file
/// Newton's linear system by conjugate gradients between symmetric Gauss-Seidel sweeps, as accurately as Newton needs.
///
/// What        NewtonLinearSolver: no factorisation; the Hessian's lower half is read twice an iteration, in `Inner` precision.
/// Accuracy    relative_tolerance in the norm of the preconditioner's inverse, which is close to that of the energy: the step
///             promises a decrease that is smaller by about relative_tolerance^2. What a precision cannot reach in one run
///             comes from more runs on the residual of the Hessian itself.
/// Indefinite  found where a direction of the iteration has negative curvature; one that the right-hand side does not excite
///             stays unseen, which a factorisation would find.
/// Source      Eisenstat 1981; Nocedal & Wright 2006, alg. 7.1 (inexact Newton)
/// Cost        8 to 20 iterations for a tolerance of a tenth on thin flesh over bones; no allocation while the pattern stays
/// Tests       tests/unit/solver/gauss_seidel_cg_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/sparse/block_gauss_seidel.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S, RealScalar Inner = float>
class GaussSeidelCg {
public:
    using Scalar = S;

    /// Per run; flesh needs a tenth of it.
    static constexpr int max_iterations = 500;

    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<Scalar>& H, const VectorX<Scalar>& rhs, Scalar relative_tolerance,
                            VectorX<Scalar>& p, const E& executor) {
        p.setZero(rhs.size());
        const Scalar size = rhs.norm();
        if (!std::isfinite(size) || !matrix_.factorize(H)) {
            return {.is_positive_definite = false, .iterations = 0};
        }
        if (size == Scalar(0)) {
            return {.is_positive_definite = true, .iterations = 0};
        }
        tolerance_ = relative_tolerance;
        LinearSolveResult result = run(rhs, Scalar(1) / size, std::max(relative_tolerance, reachable), p);
        const Scalar target = relative_tolerance * Scalar(start_norm_) * size;
        for (int runs = 1; relative_tolerance < reachable && result.is_positive_definite && runs < max_runs; ++runs) {
            H.multiply_into(p, product_, executor);
            residual_ = rhs - product_;
            const Scalar rest = residual_.norm();
            if (!(rest > Scalar(0))) {
                break;
            }
            matrix_.enter(residual_, Scalar(1) / rest, r_);
            const Scalar norm = rest * Scalar(r_.norm());
            if (norm <= target) {
                break;
            }
            const LinearSolveResult more =
                run(residual_, Scalar(1) / rest, std::max(target / norm, reachable), correction_);
            p += correction_;
            result = {.is_positive_definite = more.is_positive_definite,
                      .iterations = result.iterations + more.iterations};
        }
        return result;
    }

    /// With the last Hessian, to the last tolerance or what one run reaches.
    void solve_again(const VectorX<Scalar>& rhs, VectorX<Scalar>& p) {
        const Scalar size = rhs.norm();
        p.setZero(rhs.size());
        if (size > Scalar(0)) {
            (void)run(rhs, Scalar(1) / size, std::max(tolerance_, reachable), p);
        }
    }

private:
    /// Below this the recursion's residual and the true one part.
    static constexpr Scalar reachable = Scalar(4096) * Scalar(std::numeric_limits<Inner>::epsilon());
    static constexpr int max_runs = 10;

    LinearSolveResult run(const VectorX<Scalar>& rhs, Scalar factor, Scalar relative_tolerance, VectorX<Scalar>& p) {
        matrix_.enter(rhs, factor, r_);
        x_.setZero(r_.size());
        direction_ = r_;
        Inner rr = r_.squaredNorm();
        start_norm_ = std::sqrt(rr);
        const Inner target = Inner(relative_tolerance * relative_tolerance) * rr;
        LinearSolveResult result{.is_positive_definite = true, .iterations = 0};
        while (result.iterations < max_iterations && rr > target) {
            ++result.iterations;
            matrix_.multiply_into(direction_, scratch_, product_of_direction_);
            const Inner curvature = direction_.dot(product_of_direction_);
            if (!(curvature > Inner(0))) {
                result.is_positive_definite = false;
                return result;
            }
            const Inner alpha = rr / curvature;
            x_ += alpha * direction_;
            r_ -= alpha * product_of_direction_;
            const Inner rr_next = r_.squaredNorm();
            direction_ = r_ + (rr_next / rr) * direction_;
            rr = rr_next;
        }
        matrix_.leave(x_, Scalar(1) / factor, scratch_, p);
        return result;
    }

    BlockGaussSeidel<Inner> matrix_;
    VectorX<Inner> r_, x_, direction_, product_of_direction_, scratch_;
    VectorX<Scalar> product_, residual_, correction_;
    Scalar tolerance_ = Scalar(0);
    Inner start_norm_ = Inner(0);
};

}  // namespace softtissue
