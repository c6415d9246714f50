// SPDX-License-Identifier: MIT
/// @file
/// From deformation gradients back to positions: one factorisation per rest shape, two triangular solves per frame.
///
/// What        the positions whose gradients are nearest to given ones, with prescribed vertices held.
/// Equation    min_x sum_c V_c |F_c(x) - T_c|^2,  F_c = sum_i x_i g_i^T   <=>   (G^T W G) x = G^T W T  on the free vertices,
///             W = diag(V): a scalar matrix, three right-hand sides
/// Shapes      targets, gradients 3 x 3 cells (F_c in columns 3c to 3c + 2); positions 3 x vertices [m]
/// Valid       any targets. Targets that are the gradients of a shape with the same prescribed vertices give that shape.
///             The right-hand side is that of the correction x_new - x: a start near the result costs nothing and, in
///             float, keeps digits; the free columns of x must be finite, no more.
/// Refuses     a mesh that CellMesh::validate() refuses; prescribed vertices that leave the operator singular, such as a free
///             prism, whose gradient does not see its six hourglass modes (InvalidInput); arrays of another size.
/// Source      Nolte et al. 2026, eq. (9) and (10); Botsch et al. 2006
/// Cost        per frame: one pass over the gradient operator, two over the factor. No allocation.
/// Tests       tests/unit/solver/poisson_reconstruction_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/sparse/cholesky_factor.hpp>

#include <Eigen/SparseCore>

#include <utility>
#include <vector>

namespace softtissue {

template <class ElementType, RealScalar S>
class PoissonReconstruction {
public:
    using Scalar = S;
    using Mesh = CellMesh<ElementType, Scalar>;
    static constexpr int num_nodes = ElementType::num_nodes;

    PoissonReconstruction(const Mesh& mesh, PrescribedVertices prescribed)
        : prescribed_(std::move(prescribed)),
          assembly_(validated(mesh, prescribed_).cells, mesh.num_vertices()),
          rest_(RestOperators<ElementType, Scalar>::at(mesh, mesh.rest_positions)),
          factor_(normal_matrix(), "Poisson reconstruction (free vertices)"),
          right_hand_side_(3, mesh.num_vertices()),
          correction_(CholeskyFactor<Scalar>::RightHandSides::Zero(4, factor_.num_places())) {}

    Index num_cells() const { return assembly_.num_stencils(); }
    Index num_vertices() const { return assembly_.num_vertices(); }
    const PrescribedVertices& prescribed() const { return prescribed_; }
    const RestOperators<ElementType, Scalar>& rest() const { return rest_; }
    const CholeskyFactor<Scalar>& factor() const { return factor_; }

    /// F_c of the positions x.
    template <Executor E = SequentialExecutor>
    void gradients_into(const Matrix3X<Scalar>& x, Matrix3X<Scalar>& gradients, const E& executor = {}) const {
        require_positions(x);
        gradients.resize(3, 3 * num_cells());
        executor.for_each_range(num_cells(), [&](Index begin, Index end) {
            for (Index c = begin; c < end; ++c) {
                gradients.template middleCols<3>(3 * c) = gradient(x, c);
            }
        });
    }

    /// Replaces the free columns of x; the prescribed ones are given.
    template <Executor E = SequentialExecutor>
    void solve_into(const Matrix3X<Scalar>& targets, Matrix3X<Scalar>& x, const E& executor = {}) {
        require_positions(x);
        require(targets.cols() == 3 * num_cells(), "Poisson reconstruction: ", targets.cols(),
                " columns of target gradients, expected three for each of ", num_cells(), " cells");
        right_hand_side_.setZero();
        assembly_.add_gradient(
            executor,
            [&](Index c) -> NodePositions<ElementType, Scalar> {
                const Matrix3<Scalar> missing = targets.template middleCols<3>(3 * c) - gradient(x, c);
                return rest_.volumes(c) * missing * rest_.gradients.template middleCols<num_nodes>(num_nodes * c);
            },
            right_hand_side_);
        const std::vector<std::int32_t>& free = prescribed_.free_vertices();
        for (Index k = 0; k < factor_.size(); ++k) {
            correction_.col(factor_.place(k)).template head<3>() = right_hand_side_.col(free[size_t(k)]);
        }
        factor_.solve_in_place(correction_);
        for (Index k = 0; k < factor_.size(); ++k) {
            x.col(free[size_t(k)]) += correction_.col(factor_.place(k)).template head<3>();
        }
    }

private:
    static const Mesh& validated(const Mesh& mesh, const PrescribedVertices& prescribed) {
        mesh.validate();
        require(prescribed.num_vertices() == mesh.num_vertices(), "Poisson reconstruction: prescribed vertices of ",
                prescribed.num_vertices(), " vertices, expected ", mesh.num_vertices());
        return mesh;
    }

    void require_positions(const Matrix3X<Scalar>& x) const {
        require(x.cols() == num_vertices(), "Poisson reconstruction: ", x.cols(), " positions, expected ", num_vertices());
    }

    Matrix3<Scalar> gradient(const Matrix3X<Scalar>& x, Index cell) const {
        const NodePositions<ElementType, Scalar> nodes = Mesh::gather(x, assembly_.stencils().col(cell));
        return nodes * rest_.gradients.template middleCols<num_nodes>(num_nodes * cell).transpose();
    }

    /// G^T W G on the free vertices, in double whatever the scalar.
    Eigen::SparseMatrix<double> normal_matrix() const {
        using NodeMatrix = Eigen::Matrix<double, num_nodes, num_nodes>;
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(size_t(num_nodes * num_nodes * num_cells()));
        for (Index c = 0; c < num_cells(); ++c) {
            const Eigen::Matrix<double, 3, num_nodes> g = rest_.cell_gradients(c).template cast<double>();
            const NodeMatrix K = double(rest_.volumes(c)) * g.transpose() * g;
            for (int a = 0; a < num_nodes; ++a) {
                const std::int32_t row = prescribed_.free_index(assembly_.stencils()(a, c));
                for (int b = 0; b < num_nodes && row != PrescribedVertices::prescribed; ++b) {
                    const std::int32_t column = prescribed_.free_index(assembly_.stencils()(b, c));
                    if (column != PrescribedVertices::prescribed && column <= row) {
                        entries.emplace_back(row, column, K(a, b));
                    }
                }
            }
        }
        Eigen::SparseMatrix<double> K(prescribed_.num_free(), prescribed_.num_free());
        K.setFromTriplets(entries.begin(), entries.end());
        return K;
    }

    PrescribedVertices prescribed_;
    StencilAssembly<num_nodes, Scalar> assembly_;
    RestOperators<ElementType, Scalar> rest_;
    CholeskyFactor<Scalar> factor_;
    Matrix3X<Scalar> right_hand_side_;
    typename CholeskyFactor<Scalar>::RightHandSides correction_;
};

}  // namespace softtissue
