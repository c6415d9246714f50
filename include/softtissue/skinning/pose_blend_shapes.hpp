// SPDX-License-Identifier: MIT
/// @file
/// Pose blend shapes without their zeros: where a vertex goes for the rotations of the few joints that move it.
///
/// What        offset(v, features): three rows of P features
/// Equation    delta_v = sum over the columns c that are not zero for v of P_v,c features_c
/// Shapes      P 3n x features, row 3v + d; features a vector
/// Layout      runs of consecutive columns (nine for each joint near the vertex), three numbers a column, vertex after vertex: no
///             index a number, and one column is one load. Columns that are zero in all three rows are left out, exactly.
/// Cost        6 flop and 3 numbers per column that is not zero
/// Tests       tests/unit/skinning/pose_blend_shapes_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
class PoseBlendShapes {
public:
    using Scalar = S;
    using SparseMatrix = Eigen::SparseMatrix<Scalar, Eigen::RowMajor>;

    PoseBlendShapes() : PoseBlendShapes(SparseMatrix(0, 0)) {}

    explicit PoseBlendShapes(const SparseMatrix& directions) : num_features_(directions.cols()) {
        SOFTTISSUE_ASSERT(directions.rows() % 3 == 0);
        MatrixX<Scalar> columns = MatrixX<Scalar>::Zero(3, num_features_);
        std::vector<std::int32_t> used;
        for (Index v = 0; v < directions.rows() / 3; ++v) {
            used.clear();
            for (int d = 0; d < 3; ++d) {
                for (typename SparseMatrix::InnerIterator entry(directions, 3 * v + d); entry; ++entry) {
                    columns(d, entry.col()) = entry.value();
                    if (entry.value() != Scalar(0)) {
                        used.push_back(static_cast<std::int32_t>(entry.col()));
                    }
                }
            }
            std::sort(used.begin(), used.end());
            used.erase(std::unique(used.begin(), used.end()), used.end());
            vertices_.push_back({runs_.size(), values_.size()});
            for (const std::int32_t column : used) {
                if (runs_.size() == vertices_.back().run || runs_.back().end != column) {
                    runs_.push_back({column, column});
                }
                ++runs_.back().end;
                for (int d = 0; d < 3; ++d) {
                    values_.push_back(columns(d, column));
                    columns(d, column) = Scalar(0);
                }
            }
        }
        vertices_.push_back({runs_.size(), values_.size()});
        values_.push_back(Scalar(0));  // four numbers are loaded for three
    }

    Index num_vertices() const { return Index(vertices_.size()) - 1; }
    Index num_features() const { return num_features_; }
    /// What the offsets of all vertices read, without features.
    Index num_bytes() const {
        return Index(values_.size() * sizeof(Scalar) + runs_.size() * sizeof(Run) + vertices_.size() * sizeof(Begin));
    }

    Vector3<Scalar> offset(Index vertex, const VectorX<Scalar>& features) const {
        SOFTTISSUE_ASSERT(vertex >= 0 && vertex < num_vertices() && features.size() == num_features_);
        const Run* run = runs_.data() + vertices_[size_t(vertex)].run;
        const Run* const last = runs_.data() + vertices_[size_t(vertex) + 1].run;
        const Scalar* value = values_.data() + vertices_[size_t(vertex)].value;
        Lanes even = Lanes::Zero(), odd = Lanes::Zero();  // two sums, that one does not wait for the other
        for (; run != last; ++run) {
            std::int32_t c = run->begin;
            for (; c + 1 < run->end; c += 2, value += 6) {
                even += features(c) * lanes(value);
                odd += features(c + 1) * lanes(value + 3);
            }
            if (c < run->end) {
                even += features(c) * lanes(value);
                value += 3;
            }
        }
        return (even + odd).template head<3>();
    }

private:
    using Lanes = Eigen::Array<Scalar, 4, 1>;
    static Eigen::Map<const Lanes> lanes(const Scalar* numbers) { return Eigen::Map<const Lanes>(numbers); }

    struct Run {
        std::int32_t begin, end;
    };
    struct Begin {
        std::size_t run, value;
    };

    Index num_features_;
    std::vector<Begin> vertices_;  // and the end
    std::vector<Run> runs_;
    std::vector<Scalar> values_;
};

}  // namespace softtissue
