// SPDX-License-Identifier: MIT
/// @file
/// The sparse Cholesky factorisation that is used where none is asked for.
///
/// What        Eigen's LL^T with the approximate minimum degree ordering: float and double, no further library.
/// Tests       tests/unit/sparse/default_cholesky_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <Eigen/SparseCholesky>

namespace softtissue {

/// Satisfies the concept SparseCholesky.
template <RealScalar S>
using DefaultCholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<S>, Eigen::Lower>;

}  // namespace softtissue
