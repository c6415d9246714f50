// SPDX-License-Identifier: MIT
/// @file
/// A symmetric matrix of 3x3 blocks between the two halves of its symmetric Gauss-Seidel preconditioner, for little more than
/// the price of a product with the matrix alone.
///
/// What        A = L + D + L^T with block-diagonal D = relaxation C C^T; L~ = C^-1 L C^-T. Conjugate gradients on
///             A^ = (I + L~)^-1 C^-1 A C^-T (I + L~^T)^-1 are those on A preconditioned by symmetric successive over-relaxation.
/// Equation    A^ v = t + (I + L~)^-1 (v + (relaxation - 2) t),  t = (I + L~^T)^-1 v
/// Shapes      vectors in here hold four numbers a vertex, the fourth 0; those outside three.
/// Valid       positive definite diagonal blocks; factorize() is false otherwise. A may be of another precision.
/// Order       the vertices' own: neighbours should not lie far apart, a random order takes a third more iterations.
/// Source      Eisenstat 1981
/// Cost        an application reads the lower half twice: 18 sizeof(S) + 8 bytes a block. Sequential: every row waits for
///             rows before it. Allocates when the pattern is new.
/// Tests       tests/unit/sparse/block_gauss_seidel_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/block_pattern.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace softtissue {

template <RealScalar S>
class BlockGaussSeidel {
public:
    using Scalar = S;

    /// Of the vectors inside, per vertex.
    static constexpr int stride = 4;
    /// 1 is Gauss-Seidel; from 1.1 to 1.4 conjugate gradients on flesh need a tenth less iterations.
    static constexpr S relaxation = S(1.2);

    Index num_vertices() const { return Index(diagonal_ranks_.size()); }

    /// Takes over the values of A; false if a diagonal block is not positive definite.
    template <RealScalar T>
    bool factorize(const BlockMatrix<T>& A) {
        if (!is_analyzed_ || !(pattern_ == A.pattern())) {
            analyze(A.pattern());
        }
        const T* const values = A.matrix().valuePtr();
        for (Index i = 0; i < num_vertices(); ++i) {
            if (!invert_root(values + A.column_begin(i, 0) + 3 * diagonal_ranks_[size_t(i)], A.column_size(i),
                             roots_.data() + 9 * i)) {
                return false;
            }
        }
        Scalar* block = blocks_.data();
        for (Index i = 0; i < num_vertices(); ++i) {
            const std::span<const std::int32_t> rows = pattern_.rows(i);
            const T* entry = values + A.column_begin(i, 0) + 3 * diagonal_ranks_[size_t(i)];
            for (size_t k = size_t(diagonal_ranks_[size_t(i)]) + 1; k < rows.size(); ++k, block += 9) {
                entry += 3;
                scale_block(entry, A.column_size(i), roots_.data() + 9 * i, roots_.data() + 9 * rows[k], block);
            }
        }
        return true;
    }

    /// v = (I + L~)^-1 C^-1 factor b
    template <RealScalar T>
    void enter(const VectorX<T>& b, T factor, VectorX<Scalar>& v) const {
        v.resize(stride * num_vertices());
        for (Index i = 0; i < num_vertices(); ++i) {
            const Scalar* const R = roots_.data() + 9 * i;
            const Scalar b0 = Scalar(factor * b(3 * i)), b1 = Scalar(factor * b(3 * i + 1)),
                         b2 = Scalar(factor * b(3 * i + 2));
            Scalar* const v_i = v.data() + stride * i;
            v_i[0] = R[0] * b0;
            v_i[1] = R[1] * b0 + R[4] * b1;
            v_i[2] = R[2] * b0 + R[5] * b1 + R[8] * b2;
            v_i[3] = Scalar(0);
        }
        sweep_forward(v.data(), [](Index, const Lanes& w) { return w; });
    }

    /// p = factor C^-T (I + L~^T)^-1 v; `scratch` is overwritten.
    template <RealScalar T>
    void leave(const VectorX<Scalar>& v, T factor, VectorX<Scalar>& scratch, VectorX<T>& p) const {
        scratch.resize(v.size());
        p.resize(3 * num_vertices());
        sweep_backward(v.data(), scratch.data(), [](Index, const Lanes&, const Lanes&) {});
        for (Index i = 0; i < num_vertices(); ++i) {
            const Scalar* const R = roots_.data() + 9 * i;
            const Scalar* const t = scratch.data() + stride * i;
            p(3 * i) = factor * T(R[0] * t[0] + R[1] * t[1] + R[2] * t[2]);
            p(3 * i + 1) = factor * T(R[4] * t[1] + R[5] * t[2]);
            p(3 * i + 2) = factor * T(R[8] * t[2]);
        }
    }

    /// w = A^ v; `scratch` is overwritten.
    void multiply_into(const VectorX<Scalar>& v, VectorX<Scalar>& scratch, VectorX<Scalar>& w) const {
        scratch.resize(v.size());
        w.resize(v.size());
        Scalar* const t = scratch.data();
        Scalar* const u = w.data();
        sweep_backward(v.data(), t, [u](Index i, const Lanes& v_i, const Lanes& t_i) {
            Lanes(v_i + (relaxation - Scalar(2)) * t_i).store(u + stride * i);
        });
        sweep_forward(u, [t](Index i, const Lanes& w_i) { return w_i + Lanes::load(t + stride * i); });
    }

private:
    using Lanes = Pack<Scalar, stride>;

    void analyze(const BlockPattern& pattern) {
        pattern_ = pattern;
        const Index n = pattern.num_columns();
        diagonal_ranks_.resize(size_t(n));
        for (Index i = 0; i < n; ++i) {
            diagonal_ranks_[size_t(i)] = pattern.rank(i, static_cast<std::int32_t>(i));
        }
        roots_.resize(9 * n);
        blocks_.setZero(9 * (pattern.num_blocks() - n) / 2 + 1);  // the last block is read one number beyond its end
        is_analyzed_ = true;
    }

    /// R = C^-1, lower triangular, column-major, of the block at D, whose columns are `column_size` apart.
    template <RealScalar T>
    static bool invert_root(const T* D, Index column_size, Scalar* R) {
        const T* const D1 = D + column_size;
        const T* const D2 = D1 + column_size;
        const T c00 = D[0];
        const T l10 = D[1] / c00, l20 = D[2] / c00;
        const T c11 = D1[1] - l10 * D[1];
        const T l21 = (D1[2] - l20 * D[1]) / c11;
        const T c22 = D2[2] - l20 * D[2] - l21 * (D1[2] - l20 * D[1]);
        const T largest = std::numeric_limits<T>::max();
        if (!(c00 > T(0) && c11 > T(0) && c22 > T(0) && c00 <= largest && c11 <= largest && c22 <= largest)) {
            return false;
        }
        const T root = std::sqrt(T(relaxation));
        const T r0 = root / std::sqrt(c00), r1 = root / std::sqrt(c11), r2 = root / std::sqrt(c22);
        R[0] = Scalar(r0);
        R[1] = Scalar(-l10 * r1);
        R[2] = Scalar((l21 * l10 - l20) * r2);
        R[3] = Scalar(0);
        R[4] = Scalar(r1);
        R[5] = Scalar(-l21 * r2);
        R[6] = Scalar(0);
        R[7] = Scalar(0);
        R[8] = Scalar(r2);
        return true;
    }

    /// to = R_row block R_column^T
    template <RealScalar T>
    static void scale_block(const T* block, Index column_size, const Scalar* R_column, const Scalar* R_row,
                            Scalar* to) {
        Scalar half[9];
        for (int r = 0; r < 3; ++r) {
            const Scalar b0 = Scalar(block[r]), b1 = Scalar(block[column_size + r]),
                         b2 = Scalar(block[2 * column_size + r]);
            half[r] = b0 * R_column[0];
            half[3 + r] = b0 * R_column[1] + b1 * R_column[4];
            half[6 + r] = b0 * R_column[2] + b1 * R_column[5] + b2 * R_column[8];
        }
        for (int c = 0; c < 3; ++c) {
            const Scalar* const h = half + 3 * c;
            to[3 * c] = R_row[0] * h[0];
            to[3 * c + 1] = R_row[1] * h[0] + R_row[4] * h[1];
            to[3 * c + 2] = R_row[2] * h[0] + R_row[5] * h[1] + R_row[8] * h[2];
        }
    }

    /// w <- (I + L~)^-1 w, of which finish(i, w_i) is kept.
    template <class Finish>
    void sweep_forward(Scalar* w, const Finish& finish) const {
        const Scalar* block = blocks_.data();
        for (Index i = 0; i < num_vertices(); ++i) {
            Scalar* const w_i = w + stride * i;
            w_i[3] = Scalar(0);
            const Lanes x0(w_i[0]), x1(w_i[1]), x2(w_i[2]);
            for (const std::int32_t j : rows_below(i)) {
                Scalar* const w_j = w + stride * Index(j);
                const Lanes change =
                    Lanes::load(block) * x0 + Lanes::load(block + 3) * x1 + Lanes::load(block + 6) * x2;
                Lanes(Lanes::load(w_j) - change).store(w_j);
                block += 9;
            }
            Lanes(finish(i, Lanes::load(w_i))).store(w_i);
        }
    }

    /// t = (I + L~^T)^-1 v; watch(i, v_i, t_i) sees every vertex.
    template <class Watch>
    void sweep_backward(const Scalar* v, Scalar* t, const Watch& watch) const {
        const Scalar* block = blocks_.data() + 9 * ((pattern_.num_blocks() - num_vertices()) / 2);
        for (Index i = num_vertices(); i-- > 0;) {
            const std::span<const std::int32_t> rows = rows_below(i);
            Lanes sum0(0), sum1(0), sum2(0);
            for (size_t k = rows.size(); k-- > 0;) {
                block -= 9;
                const Lanes t_j = Lanes::load(t + stride * Index(rows[k]));
                sum0 += Lanes::load(block) * t_j;
                sum1 += Lanes::load(block + 3) * t_j;
                sum2 += Lanes::load(block + 6) * t_j;
            }
            const Lanes v_i = Lanes::load(v + stride * i);
            const Lanes t_i = v_i - Lanes::from_lanes([&](int c) {
                                  const Lanes& sum = c == 0 ? sum0 : c == 1 ? sum1 : sum2;
                                  return c == 3 ? Scalar(0) : sum[0] + sum[1] + sum[2];
                              });
            t_i.store(t + stride * i);
            watch(i, v_i, t_i);
        }
    }

    std::span<const std::int32_t> rows_below(Index i) const {
        return pattern_.rows(i).subspan(size_t(diagonal_ranks_[size_t(i)]) + 1);
    }

    BlockPattern pattern_;
    std::vector<std::int32_t> diagonal_ranks_;
    VectorX<Scalar> roots_;   // R = C^-1 of each vertex
    VectorX<Scalar> blocks_;  // of L~, column by column
    bool is_analyzed_ = false;
};

}  // namespace softtissue
