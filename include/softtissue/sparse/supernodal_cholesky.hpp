// SPDX-License-Identifier: MIT
/// @file
/// Sparse Cholesky factorisation by dense fronts: fast on solid meshes, with no library but Eigen.
///
/// What        P A P^T = L L^T, behind the five verbs of sparse/concepts.hpp. A matrix that is not positive definite ends with
///             info() == Eigen::NumericalIssue.
///                 SupernodalCholesky<double> cholesky;
///                 cholesky.compute(A);
///                 if (cholesky.info() == Eigen::Success) { x = cholesky.solve(b); }
/// Valid       a symmetric A in compressed form, of which the lower triangle is read. factorize() takes matrices of the pattern
///             that was analysed and refuses others by their number of entries (InvalidInput).
/// Reuse       copies share the analysis; one analysis can serve many factorisations, see analysis().
/// Source      Duff, Reid 1983 (multifrontal method)
/// Cost        the symbolic work once per pattern; factorize() allocates no memory of the factor's size after the first time.
///             Vectorised by Eigen as far as the compiler's target allows (-march).
/// Tests       tests/unit/sparse/supernodal_cholesky_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/cholesky_panel.hpp>
#include <softtissue/sparse/supernodal_analysis.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
class SupernodalCholesky {
public:
    using Scalar = S;
    using SparseMatrix = Eigen::SparseMatrix<Scalar>;

    SupernodalCholesky() = default;

    /// Ready for factorize() of any matrix of the analysed pattern.
    explicit SupernodalCholesky(std::shared_ptr<const SupernodalAnalysis> analysis) : analysis_(std::move(analysis)) {
        allocate();
    }

    explicit SupernodalCholesky(const SparseMatrix& A) { compute(A); }

    void compute(const SparseMatrix& A) {
        analyzePattern(A);
        factorize(A);
    }

    void analyzePattern(const SparseMatrix& A) {
        analysis_ = std::make_shared<const SupernodalAnalysis>(A);
        allocate();
    }

    void factorize(const SparseMatrix& A) {
        require(analysis_ != nullptr, "sparse Cholesky: factorize() without an analysed pattern");
        require(A.isCompressed() && A.rows() == analysis_->num_unknowns() &&
                    A.nonZeros() == analysis_->num_matrix_entries(),
                "sparse Cholesky: a matrix of ", A.rows(), " rows with ", A.nonZeros(), " entries, analysed were ",
                analysis_->num_unknowns(), " with ", analysis_->num_matrix_entries());
        info_ = Eigen::NumericalIssue;
        for (const Front& front : analysis_->fronts()) {
            if (!factorize(front, A.valuePtr())) {
                return;
            }
        }
        info_ = Eigen::Success;
    }

    Eigen::ComputationInfo info() const { return info_; }

    /// Null before the first analyzePattern().
    const std::shared_ptr<const SupernodalAnalysis>& analysis() const { return analysis_; }

    /// The columns of L that a front eliminates, over the front's rows; nothing above the diagonal is meant.
    Eigen::Map<const MatrixX<Scalar>> panel(const Front& front) const {
        return {values_.data() + front.panel, front.height, front.width};
    }

    /// A^-1 b.
    VectorX<Scalar> solve(const VectorX<Scalar>& b) const {
        SOFTTISSUE_ASSERT(info_ == Eigen::Success && b.size() == analysis_->num_unknowns());
        const std::vector<std::int32_t>& order = analysis_->order();
        VectorX<Scalar> y(b.size()), part(analysis_->largest_height()), x(b.size());
        for (size_t k = 0; k < order.size(); ++k) {
            y(Index(k)) = b(order[k]);
        }
        for (const Front& front : analysis_->fronts()) {
            substitute_forward(front, y, part);
        }
        for (size_t f = analysis_->fronts().size(); f-- > 0;) {
            substitute_backward(analysis_->fronts()[f], y, part);
        }
        for (size_t k = 0; k < order.size(); ++k) {
            x(order[k]) = y(Index(k));
        }
        return x;
    }

private:
    void allocate() {
        values_.resize(analysis_->num_values());
        for (size_t k = 0; k < 2; ++k) {
            stacks_[k].resize(analysis_->stack_sizes()[k]);
        }
        info_ = Eigen::InvalidInput;
    }

    Scalar* update_of(const Front& front) { return stacks_[size_t(front.stack)].data() + front.update; }

    bool factorize(const Front& front, const Scalar* matrix_values) {
        Scalar* const panel = values_.data() + front.panel;
        Scalar* const update = update_of(front);
        const Index below = front.num_rows_below();
        std::fill(panel, panel + front.height * front.width, Scalar(0));
        for (Index j = 0; j < below; ++j) {
            std::fill(update + j * below + j, update + (j + 1) * below, Scalar(0));
        }
        for (const FrontEntry& entry : analysis_->entries(front)) {
            panel[entry.panel_place] = matrix_values[entry.source];
        }
        for (const std::int32_t c : analysis_->children(front)) {
            add_update(analysis_->fronts()[size_t(c)], front, panel, update);
        }
        if (!factor_panel(panel, front.height, front.height, front.width)) {
            return false;
        }
        if (below > 0) {
            const detail::PanelMap<Scalar> L(panel + front.width, below, front.width,
                                             Eigen::OuterStride<>(front.height));
            Eigen::Map<MatrixX<Scalar>>(update, below, below)
                .template selfadjointView<Eigen::Lower>()
                .rankUpdate(L, Scalar(-1));
        }
        return true;
    }

    void add_update(const Front& child, const Front& front, Scalar* panel, Scalar* update) {
        const Scalar* const values = update_of(child);
        const Index below = front.num_rows_below();
        const std::span<const FrontRun> runs = analysis_->runs(child);
        for (size_t r = 0; r < runs.size(); ++r) {
            for (Index k = 0; k < runs[r].length; ++k) {
                const Index column = runs[r].parent_row + k;
                Scalar* const to = column < front.width ? panel + column * front.height
                                                        : update + (column - front.width) * below - front.width;
                const Scalar* const from = values + (runs[r].row + k) * child.num_rows_below();
                add(from + runs[r].row + k, runs[r].length - k, to + column);
                for (size_t q = r + 1; q < runs.size(); ++q) {
                    add(from + runs[q].row, runs[q].length, to + runs[q].parent_row);
                }
            }
        }
    }

    static void add(const Scalar* from, Index count, Scalar* to) {
        for (Index k = 0; k < count; ++k) {
            to[k] += from[k];
        }
    }

    void substitute_forward(const Front& front, VectorX<Scalar>& y, VectorX<Scalar>& part) const {
        const std::span<const std::int32_t> rows = analysis_->rows(front);
        Scalar* const pivots = y.data() + front.first_pivot;
        for (size_t k = 0; k < rows.size(); ++k) {
            part(Index(k)) = Scalar(0);
        }
        for (Index j = 0; j < front.width; ++j) {
            const Scalar* const column = values_.data() + front.panel + j * front.height;
            const Scalar y_j = pivots[j] / column[j];
            pivots[j] = y_j;
            for (Index i = j + 1; i < front.width; ++i) {
                pivots[i] -= column[i] * y_j;
            }
            for (size_t k = 0; k < rows.size(); ++k) {
                part(Index(k)) += column[front.width + Index(k)] * y_j;
            }
        }
        for (size_t k = 0; k < rows.size(); ++k) {
            y(rows[k]) -= part(Index(k));
        }
    }

    void substitute_backward(const Front& front, VectorX<Scalar>& y, VectorX<Scalar>& part) const {
        const std::span<const std::int32_t> rows = analysis_->rows(front);
        Scalar* const pivots = y.data() + front.first_pivot;
        for (size_t k = 0; k < rows.size(); ++k) {
            part(Index(k)) = y(rows[k]);
        }
        using Column = Eigen::Map<const VectorX<Scalar>>;
        for (Index j = front.width; j-- > 0;) {
            const Scalar* const column = values_.data() + front.panel + j * front.height;
            const Index between = front.width - j - 1;
            pivots[j] -= Column(column + j + 1, between).dot(Column(pivots + j + 1, between)) +
                         Column(column + front.width, front.num_rows_below()).dot(part.head(front.num_rows_below()));
            pivots[j] /= column[j];
        }
    }

    std::shared_ptr<const SupernodalAnalysis> analysis_;
    VectorX<Scalar> values_;
    std::array<VectorX<Scalar>, 2> stacks_;
    Eigen::ComputationInfo info_ = Eigen::InvalidInput;
};

}  // namespace softtissue
