// SPDX-License-Identifier: MIT
/// @file
/// Newton's linear system by a sparse Cholesky factorisation in every iteration.
///
/// What        NewtonLinearSolver: analyses the pattern once, factorises each Hessian; an indefinite one is reported, not solved.
/// Source      the last factor stays reachable through factor(), for sensitivities at the solution.
/// Tests       tests/unit/solver/direct_solver_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/block_pattern.hpp>
#include <softtissue/sparse/concepts.hpp>
#include <softtissue/sparse/default_cholesky.hpp>

namespace softtissue {

template <RealScalar S, SparseCholesky<S> Cholesky = DefaultCholesky<S>>
class DirectSolver {
public:
    using Scalar = S;

    /// Solves H p = rhs; `relative_tolerance` is met by construction.
    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<Scalar>& H, const VectorX<Scalar>& rhs, Scalar /*relative_tolerance*/,
                            VectorX<Scalar>& p, const E&) {
        if (!factorize(H)) {
            return {.is_positive_definite = false, .iterations = 0};
        }
        p = cholesky_.solve(rhs);
        return {.is_positive_definite = true, .iterations = 0};
    }

    /// With the last Hessian, provided that it was positive definite.
    void solve_again(const VectorX<Scalar>& rhs, VectorX<Scalar>& p) { p = cholesky_.solve(rhs); }

    /// False if H is not positive definite.
    bool factorize(const BlockMatrix<Scalar>& H) {
        if (!is_analyzed_ || !(analyzed_ == H.pattern())) {
            cholesky_.analyzePattern(H.matrix());
            analyzed_ = H.pattern();
            is_analyzed_ = true;
        }
        cholesky_.factorize(H.matrix());
        return cholesky_.info() == Eigen::Success;
    }

    /// The factor of the last Hessian, provided that it was positive definite.
    const Cholesky& factor() const { return cholesky_; }

private:
    Cholesky cholesky_;
    BlockPattern analyzed_;
    bool is_analyzed_ = false;
};

}  // namespace softtissue
