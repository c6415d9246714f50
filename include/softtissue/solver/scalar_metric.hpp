// SPDX-License-Identifier: MIT
/// @file
/// A stiffness by one number for each pair of vertices, factored once: what quasi-Newton steps and conjugate gradients start from.
///
/// What        p = Q S^-1 Q^T r for each of the three components alike
/// Equation    S_ij = trace(K_ij) / 3, the mean over directions of the stiffness K of a body, at rest say. Q = identity where
///             displacements are measured in unposed space, else the skinning maps of the pose, which carry unposed
///             displacements into the world.
/// Why         a ninth of the numbers of K in S, a fortieth of the work of factoring it, and three right-hand sides for one
///             reading of the factor: a few more iterations, each a tenth as dear. S is positive definite if K is.
/// Shapes      r, p 3 num_free; Q 3 x 3 num_free, empty for the identity
/// Refuses     factorize(): a stiffness whose S is not positive definite (InvalidInput)
/// Source      in unposed space one matrix serves all poses: Romero et al. 2020, sec. 4.2
/// Tests       tests/unit/solver/scalar_metric_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/cholesky_factor.hpp>

#include <Eigen/SparseCore>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace softtissue {

template <RealScalar S>
class ScalarMetric {
public:
    using Scalar = S;

    /// Takes the place of an earlier factor. `what` begins the message of a refusal.
    void factorize(const BlockMatrix<Scalar>& K, std::string_view what) {
        const BlockPattern& pattern = K.pattern();
        Eigen::SparseMatrix<double> mean(pattern.num_columns(), pattern.num_columns());
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(size_t(pattern.num_blocks()));
        for (Index j = 0; j < pattern.num_columns(); ++j) {
            for (std::int32_t rank = 0; rank < std::int32_t(pattern.rows(j).size()); ++rank) {
                entries.emplace_back(pattern.rows(j)[size_t(rank)], int(j), double(K.block(j, rank).trace()) / 3);
            }
        }
        mean.setFromTriplets(entries.begin(), entries.end());
        factor_.emplace(mean, what);
        sides_.setZero(4, factor_->num_places());
        maps_.resize(3, 0);
    }

    /// Q, one 3x3 map per free vertex; empty for the identity.
    Matrix3X<Scalar>& maps() { return maps_; }

    void solve_into(const VectorX<Scalar>& rhs, VectorX<Scalar>& p) {
        SOFTTISSUE_ASSERT(factor_.has_value() && rhs.size() == 3 * factor_->size());
        const bool has_maps = maps_.cols() > 0;
        for (Index v = 0; v < factor_->size(); ++v) {
            const Vector3<Scalar> side = rhs.template segment<3>(3 * v);
            sides_.col(factor_->place(v)).template head<3>() =
                has_maps ? Vector3<Scalar>(map(v).transpose() * side) : side;
        }
        factor_->solve_in_place(sides_);
        p.resize(rhs.size());
        for (Index v = 0; v < factor_->size(); ++v) {
            const Vector3<Scalar> solution = sides_.col(factor_->place(v)).template head<3>();
            p.template segment<3>(3 * v) = has_maps ? Vector3<Scalar>(map(v) * solution) : solution;
        }
    }

private:
    auto map(Index v) const { return maps_.template middleCols<3>(3 * v); }

    std::optional<CholeskyFactor<Scalar>> factor_;
    typename CholeskyFactor<Scalar>::RightHandSides sides_;
    Matrix3X<Scalar> maps_;
};

}  // namespace softtissue
