// SPDX-License-Identifier: MIT
/// @file
/// CHOLMOD at its best: one kind of factorisation, one ordering, workspaces kept from solve to solve.
///
/// What        analyzePattern() once per pattern, factorize() and solve() per matrix, of which the lower triangle is read
/// Run with    OMP_THREAD_LIMIT=1, and a BLAS that knows the processor (OpenBLAS: OPENBLAS_CORETYPE)
#pragma once

#include <softtissue/core/notation.hpp>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

#include <cstddef>

namespace benchmarks {

template <int kind, int ordering>
class TunedCholmod {
public:
    using SparseMatrix = Eigen::SparseMatrix<double>;

    TunedCholmod() {
        cholmod_start(&common_);
        common_.supernodal = kind;
        common_.final_ll = 1;
        common_.print = 0;
        common_.nmethods = 1;
        common_.method[0].ordering = ordering;
    }
    TunedCholmod(const TunedCholmod&) = delete;
    TunedCholmod& operator=(const TunedCholmod&) = delete;
    ~TunedCholmod() {
        cholmod_free_dense(&x_, &common_);
        cholmod_free_dense(&y_, &common_);
        cholmod_free_dense(&e_, &common_);
        cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }

    bool is_analyzed() const { return factor_ != nullptr; }

    void analyzePattern(const SparseMatrix& A) {
        cholmod_sparse view = Eigen::viewAsCholmod(A.selfadjointView<Eigen::Lower>());
        cholmod_free_factor(&factor_, &common_);
        factor_ = cholmod_analyze(&view, &common_);
    }

    /// False if A is not positive definite.
    bool factorize(const SparseMatrix& A) {
        cholmod_sparse view = Eigen::viewAsCholmod(A.selfadjointView<Eigen::Lower>());
        cholmod_factorize(&view, factor_, &common_);
        return common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
    }

    /// Floating-point operations of a factorisation.
    double flops() const { return common_.fl; }

    /// Valid until the next call.
    Eigen::Map<const softtissue::MatrixX<double>> solve(const softtissue::MatrixX<double>& b) {
        cholmod_dense view{};
        view.nrow = view.d = std::size_t(b.rows());
        view.ncol = std::size_t(b.cols());
        view.nzmax = std::size_t(b.size());
        view.x = const_cast<double*>(b.data());  // is only read
        view.xtype = CHOLMOD_REAL;
        view.dtype = CHOLMOD_DOUBLE;
        cholmod_solve2(CHOLMOD_A, factor_, &view, nullptr, &x_, nullptr, &y_, &e_, &common_);
        return {static_cast<const double*>(x_->x), b.rows(), b.cols()};
    }

private:
    cholmod_common common_;
    cholmod_factor* factor_ = nullptr;
    cholmod_dense* x_ = nullptr;
    cholmod_dense* y_ = nullptr;
    cholmod_dense* e_ = nullptr;
};

}  // namespace benchmarks
