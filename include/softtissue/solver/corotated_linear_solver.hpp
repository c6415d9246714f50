// SPDX-License-Identifier: MIT
/// @file
/// Co-rotated linear elasticity as a skinning method: one linear solve per pose.
///
/// What        the equilibrium of the prescribed vertices' pull, with strain measured in a given rotation per cell.
/// Equation    min_x sum_c V_c (mu |e_c|^2 + lambda/2 tr(e_c)^2),  e_c = sym(R_c^T F_c(x)) - I
/// Shapes      rotations one 3x3 per cell, such as GradientSkinning::rotations; x 3 x vertices [m], prescribed columns given
/// Source      Capell et al. 2005; Nolte et al. 2026, eq. (22) and (23): R blended from up to eight bones
/// Cost        per pose an assembly and a factorisation: the matrix depends on the rotations
/// Tests       tests/unit/solver/corotated_linear_solver_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/material/corotated_linear_field.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>

#include <span>
#include <utility>
#include <vector>

namespace softtissue {

template <class ElementType, RealScalar S, Executor ExecutorType, SparseCholesky<S> Cholesky = DefaultCholesky<S>>
class CorotatedLinearSolver {
public:
    using Scalar = S;
    using Mesh = CellMesh<ElementType, Scalar>;

    /// One set of moduli per cell. The executor must outlive this.
    CorotatedLinearSolver(const Mesh& mesh, PrescribedVertices prescribed, std::vector<LameParameters<Scalar>> moduli,
                          const ExecutorType& executor)
        : rest_positions_(mesh.rest_positions),
          elastic_(mesh, CorotatedLinearField<Scalar>(std::move(moduli))),
          objective_(std::move(prescribed), executor, elastic_) {}

    CorotatedLinearSolver(const CorotatedLinearSolver&) = delete;
    CorotatedLinearSolver& operator=(const CorotatedLinearSolver&) = delete;

    /// Replaces the free columns of x; false, and x is left as it was, where the prescribed vertices leave the system singular or
    /// the result would not be finite.
    [[nodiscard]] bool solve_into(std::span<const Matrix3<Scalar>> rotations, Matrix3X<Scalar>& x) {
        require(x.cols() == rest_positions_.cols(), "co-rotated linear: ", x.cols(), " positions, expected ",
                rest_positions_.cols());
        elastic_.field().set_rotations(rotations);
        displacement_ = x - rest_positions_;
        const VectorX<Scalar> force = -objective_.gradient(displacement_);
        const LinearSolveResult result = linear_solver_.solve(objective_.hessian(displacement_, PsdFilter::none), force,
                                                              Scalar(0), correction_, objective_.executor());
        if (!result.is_positive_definite || !correction_.allFinite()) {
            return false;
        }
        objective_.prescribed().add_into(correction_, Scalar(1), x);
        return true;
    }

private:
    Matrix3X<Scalar> rest_positions_;
    ElasticEnergy<ElementType, CorotatedLinearField<Scalar>> elastic_;
    Objective<ExecutorType, ElasticEnergy<ElementType, CorotatedLinearField<Scalar>>> objective_;
    DirectSolver<Scalar, Cholesky> linear_solver_;
    Matrix3X<Scalar> displacement_;
    VectorX<Scalar> correction_;
};

}  // namespace softtissue
