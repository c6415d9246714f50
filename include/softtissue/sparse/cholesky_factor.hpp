// SPDX-License-Identifier: MIT
/// @file
/// A sparse Cholesky factor that is kept to solve for three right-hand sides again and again.
///
/// What        L of P A P^T = L L^T, stored by columns; both triangular solves in place, without allocation.
/// Shapes      y 3 x n: one column per unknown, its three right-hand sides side by side, in the order of the pivots.
/// Why         a solve reads L twice: three right-hand sides at once cost hardly more than one; a factor computed in double
///             and kept in float costs half the bytes and loses only the last rounding
/// Refuses     a matrix that is not positive definite to rounding (InvalidInput names row, pivot and size).
/// Cost        2 reads of L, 12 flop per entry
/// Tests       tests/unit/sparse/cholesky_factor_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/default_cholesky.hpp>

#include <Eigen/SparseCore>

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace softtissue {

template <RealScalar S>
class CholeskyFactor {
public:
    using Scalar = S;

    /// Factors the symmetric A, of which the lower triangle is read. `what` begins the message of a refusal.
    CholeskyFactor(const Eigen::SparseMatrix<double>& A, std::string_view what) {
        const DefaultCholesky<double> cholesky(A);
        const Eigen::SparseMatrix<double>& L = cholesky.matrixL().nestedExpression();
        const Index n = A.rows();
        order_.resize(size_t(n));
        for (Index row = 0; row < n; ++row) {
            const Index pivot = n == cholesky.permutationP().size() ? cholesky.permutationP().indices()(row) : row;
            order_[size_t(pivot)] = static_cast<std::int32_t>(row);
        }
        require(cholesky.info() == Eigen::Success, what, ": the matrix is not positive definite");
        offsets_.push_back(0);
        for (Index j = 0; j < n; ++j) {
            Eigen::SparseMatrix<double>::InnerIterator entry(L, j);
            const double pivot = entry.value();
            const double diagonal = A.coeff(order_[size_t(j)], order_[size_t(j)]);
            require(pivot * pivot > smallest_relative_pivot * diagonal, what, ": pivot of row ", order_[size_t(j)], " = ",
                    pivot * pivot, " of ", diagonal, ", the matrix is singular to rounding");
            inverse_pivots_.push_back(Scalar(1.0 / pivot));
            for (++entry; entry; ++entry) {
                rows_.push_back(static_cast<std::int32_t>(entry.row()));
                values_.push_back(Scalar(entry.value()));
            }
            offsets_.push_back(values_.size());
        }
    }

    Index size() const { return Index(order_.size()); }

    /// Entries of L below the diagonal.
    Index num_entries() const { return Index(values_.size()); }

    /// Which row of A each pivot is.
    const std::vector<std::int32_t>& order() const { return order_; }

    /// y = (L L^T)^-1 y.
    void solve_in_place(Eigen::Ref<Matrix3X<Scalar>> y) const {
        SOFTTISSUE_ASSERT(y.cols() == size());
        for (size_t j = 0; j < order_.size(); ++j) {
            const Vector3<Scalar> y_j = y.col(Index(j)) * inverse_pivots_[j];
            y.col(Index(j)) = y_j;
            for (size_t k = offsets_[j]; k < offsets_[j + 1]; ++k) {
                y.col(rows_[k]) -= values_[k] * y_j;
            }
        }
        for (size_t j = order_.size(); j-- > 0;) {
            Vector3<Scalar> y_j = y.col(Index(j));
            for (size_t k = offsets_[j]; k < offsets_[j + 1]; ++k) {
                y_j -= values_[k] * y.col(rows_[k]);
            }
            y.col(Index(j)) = y_j * inverse_pivots_[j];
        }
    }

private:
    /// A pivot of a regular matrix keeps far more than rounding of its diagonal entry.
    static constexpr double smallest_relative_pivot = 1e4 * std::numeric_limits<double>::epsilon();

    std::vector<std::int32_t> order_;
    std::vector<Scalar> inverse_pivots_;
    std::vector<size_t> offsets_;
    std::vector<std::int32_t> rows_;
    std::vector<Scalar> values_;
};

}  // namespace softtissue
