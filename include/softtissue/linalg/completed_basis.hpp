// SPDX-License-Identifier: MIT
/// @file
/// Orthonormal columns made a basis of the whole space.
///
/// What        completed_basis(): an orthogonal matrix that begins with given columns
/// Equation    each further column is the axis that the columns so far span least, without its part along them
/// Shapes      columns: n x k orthonormal, k <= n; result n x n
/// Valid       some axis always has |part left|^2 >= (n - k) / n: nothing is divided by a small number. Orthogonal to rounding.
/// Refuses     more columns than rows (InvalidInput)
/// Cost        4 n^3 flop
/// Tests       tests/unit/linalg/completed_basis_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>

namespace softtissue {

template <RealScalar S>
MatrixX<S> completed_basis(ConstRef<MatrixX<S>> columns) {
    const Index n = columns.rows();
    require(columns.cols() <= n, "basis: ", columns.cols(), " columns of ", n, " numbers, expected at most ", n);
    MatrixX<S> basis(n, n);
    basis.leftCols(columns.cols()) = columns;
    VectorX<S> spanned = columns.rowwise().squaredNorm();
    for (Index k = columns.cols(); k < n; ++k) {
        Index axis = 0;
        spanned.minCoeff(&axis);
        VectorX<S> column = VectorX<S>::Zero(n);
        column(axis) = S(1);
        for (int pass = 0; pass < 2; ++pass) {  // the second takes away what rounding left
            for (Index i = 0; i < k; ++i) {
                column -= basis.col(i).dot(column) * basis.col(i);
            }
            column /= std::sqrt(column.squaredNorm());
        }
        basis.col(k) = column;
        spanned += column.cwiseAbs2();
    }
    return basis;
}

}  // namespace softtissue
