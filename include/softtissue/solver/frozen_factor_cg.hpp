// SPDX-License-Identifier: MIT
/// @file
/// Newton's linear system by conjugate gradients, preconditioned with one factor that is kept for a whole motion.
///
/// What        NewtonLinearSolver: the Hessian enters through products only; the factor is that of the Hessian at rest.
/// Equation    preconditioner z = Q K0^-1 Q^T r; Q = identity where displacements are measured in unposed space, else the
///             skinning maps of the pose, which carry unposed displacements into the world
/// Shapes      Q 3 x 3 num_free, empty for the identity
/// Why         in unposed space the elastic Hessian does not depend on the pose: one factor serves every frame
/// Source      Romero et al. 2020, sec. 4.2; Nocedal & Wright 2006, alg. 5.3
/// Departs     stops at negative curvature and reports an indefinite Hessian
/// Tests       tests/unit/solver/frozen_factor_cg_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/sparse/concepts.hpp>
#include <softtissue/sparse/default_cholesky.hpp>

#include <cmath>

namespace softtissue {

template <RealScalar S, SparseCholesky<S> Cholesky = DefaultCholesky<S>>
class FrozenFactorCg {
public:
    using Scalar = S;

    /// More iterations than this on one system mean that the factor no longer fits.
    static constexpr int max_iterations = 400;

    /// Factors K0; false if it is not positive definite.
    bool factorize(const BlockMatrix<Scalar>& K0) {
        factor_.compute(K0.matrix());
        return factor_.info() == Eigen::Success;
    }

    /// Q, one 3x3 map per free vertex; empty for the identity.
    Matrix3X<Scalar>& maps() { return maps_; }

    template <Executor E>
    LinearSolveResult solve(const BlockMatrix<Scalar>& H, const VectorX<Scalar>& rhs, Scalar relative_tolerance,
                            VectorX<Scalar>& p, const E& executor) {
        p.setZero(rhs.size());
        residual_ = rhs;
        const Scalar target = relative_tolerance * rhs.norm();
        precondition();
        direction_ = z_;
        Scalar rz = residual_.dot(z_);
        int iteration = 0;
        while (iteration < max_iterations && residual_.norm() > target) {
            ++iteration;
            H.multiply_into(direction_, product_, executor);
            const Scalar curvature = direction_.dot(product_);
            if (!(curvature > Scalar(0))) {
                return {.is_positive_definite = false, .iterations = iteration};
            }
            const Scalar alpha = rz / curvature;
            p += alpha * direction_;
            residual_ -= alpha * product_;
            precondition();
            const Scalar rz_next = residual_.dot(z_);
            direction_ = z_ + (rz_next / rz) * direction_;
            rz = rz_next;
        }
        return {.is_positive_definite = true, .iterations = iteration};
    }

private:
    void precondition() {
        if (maps_.cols() == 0) {
            z_ = factor_.solve(residual_);
            return;
        }
        mapped_.resize(residual_.size());
        for (Index v = 0; 3 * v < residual_.size(); ++v) {
            mapped_.template segment<3>(3 * v) =
                maps_.template middleCols<3>(3 * v).transpose() * residual_.template segment<3>(3 * v);
        }
        z_ = factor_.solve(mapped_);
        for (Index v = 0; 3 * v < residual_.size(); ++v) {
            z_.template segment<3>(3 * v) =
                (maps_.template middleCols<3>(3 * v) * z_.template segment<3>(3 * v)).eval();
        }
    }

    Cholesky factor_;
    Matrix3X<Scalar> maps_;
    VectorX<Scalar> residual_, z_, direction_, product_, mapped_;
};

}  // namespace softtissue
