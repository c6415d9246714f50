// SPDX-License-Identifier: MIT
/// @file
/// A symmetric sparse matrix of 3x3 blocks on a fixed pattern, readable as an Eigen sparse matrix.
///
/// What        values of both triangles, written block by block without a search, without triplets.
/// Shapes      3 n x 3 n for a pattern of n columns; symmetric by contract (both triangles are written by the assembly).
/// Layout      column-major compressed; in scalar column 3 j + c the block of rank r occupies entries 3 r .. 3 r + 2.
/// Memory      9 (sizeof(Scalar) + 4) bytes a block.
/// Tests       tests/unit/sparse/block_matrix_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/prefetch.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/block_pattern.hpp>

#include <Eigen/SparseCore>

namespace softtissue {

template <RealScalar S>
class BlockMatrix {
public:
    using Scalar = S;
    using SparseMatrix = Eigen::SparseMatrix<Scalar, Eigen::ColMajor, int>;

    BlockMatrix() = default;

    explicit BlockMatrix(const BlockPattern& pattern) : pattern_(pattern) {
        require_size(pattern.num_columns(), pattern.num_blocks());
        const Index n = 3 * pattern.num_columns();
        matrix_.resize(n, n);
        matrix_.resizeNonZeros(9 * pattern.num_blocks());
        int* const outer = matrix_.outerIndexPtr();
        int* const inner = matrix_.innerIndexPtr();
        for (Index j = 0; j < pattern.num_columns(); ++j) {
            const std::span<const std::int32_t> rows = pattern.rows(j);
            for (int c = 0; c < 3; ++c) {
                Index entry = column_begin(j, c);
                outer[3 * j + c] = static_cast<int>(entry);
                for (const std::int32_t i : rows) {
                    for (int d = 0; d < 3; ++d) {
                        inner[entry++] = 3 * i + d;
                    }
                }
            }
        }
        outer[n] = static_cast<int>(9 * pattern.num_blocks());
        set_zero();
    }

    /// Refuses what 32-bit indices cannot number: above 715 million vertices or 238 million blocks.
    static void require_size(Index num_columns, Index num_blocks) {
        checked_index(3 * num_columns, "block matrix: rows");
        checked_index(9 * num_blocks, "block matrix: entries");
    }

    const BlockPattern& pattern() const { return pattern_; }
    const SparseMatrix& matrix() const { return matrix_; }

    /// Numbers in a scalar column of vertex j, and where the c-th one begins.
    Index column_size(Index j) const { return 3 * (pattern_.offset(j + 1) - pattern_.offset(j)); }
    Index column_begin(Index j, int c) const { return 9 * pattern_.offset(j) + c * column_size(j); }

    void set_zero() { matrix_.coeffs().setZero(); }

    /// The blocks of one column, for what adds many of them.
    class Column {
    public:
        /// Adds `block`, 3x3, at row pattern().rows(j)[rank].
        template <class Block>
        void add(std::int32_t rank, const Eigen::MatrixBase<Block>& block) const {
            Scalar* entries = values_ + 3 * Index(rank);
            for (int c = 0; c < 3; ++c) {
                for (int d = 0; d < 3; ++d) {
                    entries[d] += block(d, c);
                }
                entries += size_;
            }
        }

        /// Asks for all of it before it is needed.
        void prefetch() const {
            for (Index i = 0; i < 3 * size_; i += Index(64 / sizeof(Scalar))) {
                prefetch_to_write(values_ + i);
            }
        }

    private:
        friend class BlockMatrix;
        Column(Scalar* values, Index size) : values_(values), size_(size) {}

        Scalar* values_;
        Index size_;
    };

    Column column(Index j) { return {matrix_.valuePtr() + column_begin(j, 0), column_size(j)}; }

    /// Adds `block` at row pattern().rows(j)[rank], column j.
    void add(Index j, std::int32_t rank, const Matrix3<Scalar>& block) { column(j).add(rank, block); }

    /// The block at row pattern().rows(j)[rank], column j.
    Matrix3<Scalar> block(Index j, std::int32_t rank) const {
        Matrix3<Scalar> result;
        for (int c = 0; c < 3; ++c) {
            const Scalar* const column = matrix_.valuePtr() + column_begin(j, c) + 3 * rank;
            result.col(c) << column[0], column[1], column[2];
        }
        return result;
    }

    /// y = (this) x. Each entry of y is one dot product with a column, so the bits do not depend on the executor.
    template <Executor E>
    void multiply_into(const VectorX<Scalar>& x, VectorX<Scalar>& y, const E& executor) const {
        y.resize(matrix_.cols());
        executor.for_each_range(pattern_.num_columns(), [&](Index begin, Index end) {
            const Scalar* const values = matrix_.valuePtr();
            for (Index j = begin; j < end; ++j) {
                Vector3<Scalar> sum = Vector3<Scalar>::Zero();
                const std::span<const std::int32_t> rows = pattern_.rows(j);
                for (int c = 0; c < 3; ++c) {
                    const Scalar* column = values + column_begin(j, c);
                    for (const std::int32_t i : rows) {
                        const Scalar* const xi = x.data() + 3 * i;
                        sum(c) += column[0] * xi[0] + column[1] * xi[1] + column[2] * xi[2];
                        column += 3;
                    }
                }
                y.template segment<3>(3 * j) = sum;
            }
        });
    }

private:
    BlockPattern pattern_;
    SparseMatrix matrix_;
};

}  // namespace softtissue
