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
///             prism, whose gradient does not see its six hourglass modes (InvalidInput); arrays of another size; targets and
///             positions that do not give finite ones (solve_into() names the first that is not finite and leaves x alone)
/// Source      Nolte et al. 2026, eq. (9) and (10); Botsch et al. 2006
/// Cost        per frame: one pass over the gradient operator, two over the factor; both on as many threads as the executor has,
///             the factor on two. No allocation. Same bits for every executor.
/// Tests       tests/unit/solver/poisson_reconstruction_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/node_packs.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/energy/rest_packs.hpp>
#include <softtissue/energy/target_forces.hpp>
#include <softtissue/linalg/matrix_packs.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/sparse/cholesky_factor.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <class ElementType, RealScalar S>
class PoissonReconstruction {
public:
    using Scalar = S;
    using Mesh = CellMesh<ElementType, Scalar>;
    using Rest = RestOperators<ElementType, Scalar>;
    using Packs = RestPacks<ElementType, Scalar>;
    using Lanes = typename Packs::Lanes;
    static constexpr int num_nodes = ElementType::num_nodes;

    PoissonReconstruction(const Mesh& mesh, PrescribedVertices prescribed)
        : PoissonReconstruction(validated(mesh, prescribed), std::move(prescribed),
                                Rest::at(mesh, mesh.rest_positions)) {}

    Index num_cells() const { return cells_.num_cells(); }
    Index num_vertices() const { return prescribed_.num_vertices(); }
    const PrescribedVertices& prescribed() const { return prescribed_; }
    const Rest& rest() const { return rest_; }
    const CholeskyFactor<Scalar>& factor() const { return factor_; }

    /// What solve_into() reads of the operators: the factor twice.
    Index bytes_per_solve() const { return forces_.num_bytes() + 2 * factor_.num_bytes(); }

    /// F_c of the positions x.
    template <Executor E = SequentialExecutor>
    void gradients_into(const Matrix3X<Scalar>& x, Matrix3X<Scalar>& gradients, const E& executor = {}) const {
        mapped_gradients_into(
            x, gradients, executor, [](Index, const Matrix3<Lanes>& F) -> const auto& { return F; });
    }

    /// map(first, F) of the gradients F of cells `first`, `first + 1`, ... side by side, without a detour through memory; both
    /// Matrix3<Pack> of so many registers, lanes beyond the last cell repeat it.
    template <int registers = 1, Executor E, class Map>
    void mapped_gradients_into(const Matrix3X<Scalar>& x, Matrix3X<Scalar>& result, const E& executor,
                               const Map& map) const {
        require_positions(x);
        result.resize(3, 3 * num_cells());
        const Index last = packs_.num_packs() - 1;
        executor.for_each_range((last + registers) / registers, [&](Index begin, Index end) {
            for (Index group = begin; group < end; ++group) {
                const Index p = registers * group, first = Packs::width * p;
                const auto F = side_by_side<registers>([&](int k) { return gradients(x, std::min(p + k, last)); });
                store_matrices<registers * Packs::width>(map(first, F), first, result);
            }
        });
    }

    /// Replaces the free columns of x; the prescribed ones are given.
    template <Executor E = SequentialExecutor>
    void solve_into(const Matrix3X<Scalar>& targets, Matrix3X<Scalar>& x, const E& executor = {}) {
        if (!solve_finite_into(targets, x, executor)) {
            refuse(targets, x);
        }
    }

    /// The same where the result is finite; else false, and x stays.
    template <Executor E = SequentialExecutor>
    [[nodiscard]] bool solve_finite_into(const Matrix3X<Scalar>& targets, Matrix3X<Scalar>& x, const E& executor = {}) {
        require_positions(x);
        require(targets.cols() == 3 * num_cells(), "Poisson reconstruction: ", targets.cols(),
                " columns of target gradients, expected three for each of ", num_cells(), " cells");
        executor.for_each_range(num_vertices(), [&](Index begin, Index end) {
            start_.template topRows<3>().middleCols(begin, end - begin) = x.middleCols(begin, end - begin);
        });
        const std::vector<std::int32_t>& free = prescribed_.free_vertices();
        executor.for_each_range(factor_.size(), [&](Index begin, Index end) {
            forces_.for_each(begin, end, targets, start_, free,
                             [&](Index v, const auto& force) { correction_.col(factor_.place(v)) = force; });
        });
        factor_.solve_in_place(correction_, executor);
        if (!std::isfinite(correction_.sum()) && !correction_.allFinite()) {
            correction_.setZero();  // what belongs to no unknown must be finite at the next call
            return false;
        }
        executor.for_each_range(factor_.size(), [&](Index begin, Index end) {
            for (Index v = begin; v < end; ++v) {
                x.col(free[size_t(v)]) += correction_.col(factor_.place(v)).template head<3>();
            }
        });
        return true;
    }

private:
    PoissonReconstruction(const Mesh& mesh, PrescribedVertices&& prescribed, const Rest& rest)
        : PoissonReconstruction(mesh, std::move(prescribed), rest, normal_matrix(mesh, rest)) {}

    PoissonReconstruction(const Mesh& mesh, PrescribedVertices&& prescribed, const Rest& rest,
                          const Eigen::SparseMatrix<double>& K)
        : prescribed_(std::move(prescribed)),
          cells_(mesh.cells),
          rest_(rest),
          packs_(rest),
          forces_(rest, mesh.cells, K, prescribed_),
          factor_(free_part(K), "Poisson reconstruction (free vertices)"),
          start_(TargetForces<Scalar>::Positions::Zero(4, mesh.num_vertices())),
          correction_(CholeskyFactor<Scalar>::RightHandSides::Zero(4, factor_.num_places())) {}

    static const Mesh& validated(const Mesh& mesh, const PrescribedVertices& prescribed) {
        mesh.validate();
        require(prescribed.num_vertices() == mesh.num_vertices(), "Poisson reconstruction: prescribed vertices of ",
                prescribed.num_vertices(), " vertices, expected ", mesh.num_vertices());
        return mesh;
    }

    [[noreturn]] static void refuse(const Matrix3X<Scalar>& targets, const Matrix3X<Scalar>& x) {
        for (Index c = 0; c < targets.cols() / 3; ++c) {
            require(targets.template middleCols<3>(3 * c).allFinite(),
                    "Poisson reconstruction: target gradient of cell ", c, " is not finite");
        }
        for (Index v = 0; v < x.cols(); ++v) {
            require(x.col(v).allFinite(), "Poisson reconstruction: position of vertex ", v, " is not finite");
        }
        throw_invalid_input("Poisson reconstruction: positions or targets too large for the range of the numbers");
    }

    void require_positions(const Matrix3X<Scalar>& x) const {
        require(x.cols() == num_vertices(), "Poisson reconstruction: ", x.cols(), " positions, expected ",
                num_vertices());
    }

    /// Of a pack of cells; positions relative to a node of each cell, where they are small and lose no digits.
    Matrix3<Lanes> gradients(const Matrix3X<Scalar>& x, Index pack) const {
        const NodePositions<ElementType, Lanes> nodes = cells_.gather(x, pack);
        const auto g = packs_.packed_gradients(pack);
        Matrix3<Lanes> F = Matrix3<Lanes>::Zero();
        for (int a = 1; a < num_nodes; ++a) {
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) {
                    F(i, j) += (nodes(i, a) - nodes(i, 0)) * g(j, a);
                }
            }
        }
        return F;
    }

    /// G^T W G, in double whatever the scalar.
    static Eigen::SparseMatrix<double> normal_matrix(const Mesh& mesh, const Rest& rest) {
        using NodeMatrix = Eigen::Matrix<double, num_nodes, num_nodes>;
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(size_t(checked_index(num_nodes * num_nodes * mesh.num_cells(),
                                             "Poisson reconstruction: entries before they are summed")));
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            const Eigen::Matrix<double, 3, num_nodes> g = rest.cell_gradients(c).template cast<double>();
            const NodeMatrix K = double(rest.volumes(c)) * g.transpose() * g;
            for (int a = 0; a < num_nodes; ++a) {
                for (int b = 0; b < num_nodes; ++b) {
                    entries.emplace_back(mesh.cells(a, c), mesh.cells(b, c), K(a, b));
                }
            }
        }
        Eigen::SparseMatrix<double> K(mesh.num_vertices(), mesh.num_vertices());
        K.setFromTriplets(entries.begin(), entries.end());
        return K;
    }

    /// The lower triangle of the free rows and columns.
    Eigen::SparseMatrix<double> free_part(const Eigen::SparseMatrix<double>& K) const {
        std::vector<Eigen::Triplet<double>> entries;
        for (Index v = 0; v < prescribed_.num_free(); ++v) {
            for (Eigen::SparseMatrix<double>::InnerIterator entry(K, prescribed_.free_vertices()[size_t(v)]); entry;
                 ++entry) {
                const std::int32_t row = prescribed_.free_index(entry.row());
                if (row >= v) {  // prescribed rows are negative
                    entries.emplace_back(row, static_cast<std::int32_t>(v), entry.value());
                }
            }
        }
        Eigen::SparseMatrix<double> result(prescribed_.num_free(), prescribed_.num_free());
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    PrescribedVertices prescribed_;
    NodePacks<num_nodes, Packs::width> cells_;
    Rest rest_;
    Packs packs_;
    TargetForces<Scalar> forces_;
    CholeskyFactor<Scalar> factor_;
    typename TargetForces<Scalar>::Positions start_;
    typename CholeskyFactor<Scalar>::RightHandSides correction_;
};

}  // namespace softtissue
