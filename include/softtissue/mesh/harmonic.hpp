// SPDX-License-Identifier: MIT
/// @file
/// Smooth interpolation of values from prescribed vertices to all vertices of a mesh.
///
///     const HarmonicInterpolation<double> from_skin(cotangent_laplacian(tets), skin_vertices);
///     const MatrixX<double> weights = from_skin.interpolate(skin_weights);
///
/// What        minimises w^T Q w with prescribed entries of w; one factorisation for any number of values.
///             Q = cotangent_laplacian(...): harmonic, as flat as possible.
///             Q = bilaplacian(...): biharmonic, no kink at prescribed vertices, may overshoot far.
/// Equation    Q_ff w_f = -Q_fp w_p, f the free and p the prescribed vertices
/// Shapes      values c prescribed x k with c numbers a vertex, row c i + d for the i-th prescribed vertex (skinning
///             weights: c = 1; blend shapes: c = 3, rows as in SmplBody); result c vertices x k, row c v + d
/// Valid       harmonic: linear functions are reproduced on flat and volume meshes with prescribed boundary. Values
///             stay between the smallest and the largest prescribed one if Q has no positive entry off the diagonal (no
///             obtuse angle); with some they can leave the range slightly: clamp and normalise skinning weights.
/// Refuses     no prescribed vertex, one out of range or listed twice, a vertex that no path in Q joins to a prescribed
///             one, values of another number of rows or not finite (InvalidInput names the vertex)
/// Cost        one sparse Cholesky factorisation; per column two triangular solves. A sparse argument costs only for
///             its columns that are not empty.
/// Tests       tests/unit/mesh/harmonic_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace softtissue {

template <RealScalar S>
class HarmonicInterpolation {
public:
    using Scalar = S;
    using SparseMatrix = Eigen::SparseMatrix<Scalar>;

    /// `energy` is symmetric and positive semi-definite, its null space the constants of each component.
    HarmonicInterpolation(const SparseMatrix& energy, std::span<const std::int32_t> prescribed)
        : prescribed_(prescribed.begin(), prescribed.end()) {
        require(energy.rows() == energy.cols(), "interpolation: energy is ", energy.rows(), " x ", energy.cols(),
                ", expected a square matrix");
        number_vertices(energy.rows());
        require_connected(energy);
        factorise(energy);
    }

    Index num_vertices() const { return Index(slot_.size()); }
    Index num_prescribed() const { return Index(prescribed_.size()); }

    /// The values at all vertices; those at prescribed vertices are copied.
    MatrixX<Scalar> interpolate(ConstRef<MatrixX<Scalar>> values) const {
        const Index components = components_of(values.rows());
        require_finite(values, components);
        MatrixX<Scalar> result(components * num_vertices(), values.cols());
        for (Index d = 0; d < components; ++d) {
            const Eigen::Map<const MatrixX<Scalar>, 0, Strides> given(
                values.data() + d, num_prescribed(), values.cols(), Strides(values.outerStride(), components));
            Eigen::Map<MatrixX<Scalar>, 0, Strides> all(result.data() + d, num_vertices(), values.cols(),
                                                        Strides(result.outerStride(), components));
            MatrixX<Scalar> solved;
            if (num_free_ > 0) {
                const MatrixX<Scalar> load = coupling_ * given;
                solved = factor_->solve(load);
            }
            for (Index v = 0; v < num_vertices(); ++v) {
                const Index slot = slot_[size_t(v)];
                if (slot < 0) {
                    all.row(v) = given.row(-1 - slot);
                } else {
                    all.row(v) = -solved.row(slot);
                }
            }
        }
        require(result.allFinite(), "interpolation: the values are too large for the range of the numbers");
        return result;
    }

    /// The same for sparse values: the result keeps what exceeds `smallest` in magnitude, and the prescribed entries.
    SparseMatrix interpolate(const SparseMatrix& values, Scalar smallest) const {
        const Index components = components_of(values.rows());
        checked_index(components * num_vertices(), "interpolation: rows of the result");
        std::vector<Index> filled;
        for (Index column = 0; column < values.cols(); ++column) {
            if (values.col(column).nonZeros() > 0) {
                filled.push_back(column);
            }
        }
        std::vector<Eigen::Triplet<Scalar>> entries;
        for (size_t first = 0; first < filled.size(); first += batch) {
            const std::span<const Index> columns(filled.data() + first, std::min(batch, filled.size() - first));
            MatrixX<Scalar> dense(values.rows(), Index(columns.size()));
            for (size_t k = 0; k < columns.size(); ++k) {
                dense.col(Index(k)) = values.col(columns[k]);
            }
            const MatrixX<Scalar> all = interpolate(dense);
            for (size_t k = 0; k < columns.size(); ++k) {
                for (Index row = 0; row < all.rows(); ++row) {
                    const Scalar value = all(row, Index(k));
                    const bool is_prescribed = slot_[size_t(row / components)] < 0;
                    if (std::abs(value) > (is_prescribed ? Scalar(0) : smallest)) {
                        entries.emplace_back(int(row), int(columns[k]), value);
                    }
                }
            }
        }
        checked_index(Index(entries.size()), "interpolation: entries of the result");
        SparseMatrix result(components * num_vertices(), values.cols());
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

private:
    using Strides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    static constexpr size_t batch = 32;  // dense columns at a time: bounds the memory, keeps the solve blocked

    void number_vertices(Index num_vertices) {
        require(!prescribed_.empty(), "interpolation: no vertex is prescribed, expected at least one");
        slot_.assign(size_t(num_vertices), 0);
        for (size_t i = 0; i < prescribed_.size(); ++i) {
            const std::int32_t v = prescribed_[i];
            require(v >= 0 && v < num_vertices, "interpolation: prescribed vertex ", v, ", expected 0 to ",
                    num_vertices - 1);
            require(slot_[size_t(v)] == 0, "interpolation: vertex ", v, " is prescribed twice");
            slot_[size_t(v)] = -1 - Index(i);
        }
        for (Index& slot : slot_) {
            if (slot == 0) {
                slot = num_free_++;
            }
        }
    }

    void require_connected(const SparseMatrix& energy) const {
        std::vector<bool> is_reached(slot_.size(), false);
        std::vector<Index> front(prescribed_.begin(), prescribed_.end());
        while (!front.empty()) {
            const Index v = front.back();
            front.pop_back();
            if (!is_reached[size_t(v)]) {
                is_reached[size_t(v)] = true;
                for (typename SparseMatrix::InnerIterator entry(energy, v); entry; ++entry) {
                    front.push_back(entry.row());
                }
            }
        }
        for (size_t v = 0; v < slot_.size(); ++v) {
            require(is_reached[v], "interpolation: vertex ", v, " is not connected to any prescribed vertex");
        }
    }

    void factorise(const SparseMatrix& energy) {
        std::vector<Eigen::Triplet<Scalar>> free_entries;
        std::vector<Eigen::Triplet<Scalar>> coupling_entries;
        for (Index column = 0; column < energy.cols(); ++column) {
            for (typename SparseMatrix::InnerIterator entry(energy, column); entry; ++entry) {
                const Index row_slot = slot_[size_t(entry.row())];
                const Index column_slot = slot_[size_t(column)];
                require(std::isfinite(entry.value()), "interpolation: energy of vertices ", entry.row(), " and ",
                        column, " is ", entry.value(), ", expected a finite value");
                if (row_slot >= 0 && column_slot >= 0) {
                    free_entries.emplace_back(int(row_slot), int(column_slot), entry.value());
                } else if (row_slot >= 0) {
                    coupling_entries.emplace_back(int(row_slot), int(-1 - column_slot), entry.value());
                }
            }
        }
        coupling_.resize(num_free_, num_prescribed());
        coupling_.setFromTriplets(coupling_entries.begin(), coupling_entries.end());
        if (num_free_ > 0) {
            SparseMatrix free_block(num_free_, num_free_);
            free_block.setFromTriplets(free_entries.begin(), free_entries.end());
            factor_ = std::make_unique<Eigen::SimplicialLDLT<SparseMatrix>>(free_block);
            require(factor_->info() == Eigen::Success && (factor_->vectorD().array() > Scalar(0)).all(),
                    "interpolation: the energy of the free vertices is not positive definite");
        }
    }

    void require_finite(ConstRef<MatrixX<Scalar>> values, Index components) const {
        if (values.allFinite()) {
            return;
        }
        for (Index row = 0; row < values.rows(); ++row) {
            require(values.row(row).allFinite(), "interpolation: a value of prescribed vertex ",
                    prescribed_[size_t(row / components)], " is not finite");
        }
    }

    Index components_of(Index rows) const {
        require(rows > 0 && rows % num_prescribed() == 0, "interpolation: values have ", rows,
                " rows, expected a multiple of the ", num_prescribed(), " prescribed vertices");
        return rows / num_prescribed();
    }

    std::vector<std::int32_t> prescribed_;
    std::vector<Index> slot_;  // per vertex: its place among the free, or -1 - its place among the prescribed
    Index num_free_ = 0;
    SparseMatrix coupling_;  // free x prescribed
    std::unique_ptr<Eigen::SimplicialLDLT<SparseMatrix>> factor_;
};

}  // namespace softtissue
