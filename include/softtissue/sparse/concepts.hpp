// SPDX-License-Identifier: MIT
/// @file
/// What a sparse direct solver is: the five verbs of Eigen's solvers.
///
/// What        analyzePattern(A) once per pattern, factorize(A) per matrix, compute(A) both, solve(b), info().
///             Eigen::SimplicialLLT is the default; sparse/cholmod.hpp offers CHOLMOD. factorize() of an indefinite matrix must
///             end with info() != Success, so LL^T and not LDL^T solvers.
/// Tests       tests/unit/sparse/concepts_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <Eigen/SparseCore>

#include <concepts>

namespace softtissue {

template <class T, class Scalar>
concept SparseCholesky =
    std::default_initializable<T> && requires(T& solver, const Eigen::SparseMatrix<Scalar>& A, const VectorX<Scalar>& b) {
        solver.analyzePattern(A);
        solver.factorize(A);
        solver.compute(A);
        VectorX<Scalar>(solver.solve(b));
        { solver.info() } -> std::same_as<Eigen::ComputationInfo>;
    };

}  // namespace softtissue
