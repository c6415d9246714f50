// SPDX-License-Identifier: MIT
/// @file
/// The inertia of an implicit Euler step as an energy term.
///
/// Equation    E(d) = 1/(2 dt^2) sum_i m_i |x_i - xt_i|^2,  x = p + A d,  xt = x_n + dt v_n + dt^2 a
/// Shapes      masses vertices [kg], target xt 3 x vertices [m]
/// Units       d m, energy J, gradient N, Hessian N/m (block diagonal, m/dt^2 A^T A)
/// Refuses     a time step that is not positive or whose square leaves the range of the scalar, masses that are negative or not
///             finite
/// Source      Romero et al. 2020, eq. (3), discretised by implicit Euler as a minimisation
/// Tests       tests/unit/energy/inertia_test.cpp, tests/laws/energy_laws_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
class Inertia {
public:
    using Scalar = S;

    /// Vertices without mass take no part.
    Inertia(VectorX<Scalar> masses, Scalar time_step) : masses_(std::move(masses)), time_step_(time_step) {
        require(std::isfinite(time_step) && time_step > Scalar(0), "time step = ", time_step, " s, expected > 0");
        require(std::isnormal(time_step * time_step), "time step = ", time_step,
                " s, expected a square within the range of the numbers");
        for (Index v = 0; v < masses_.size(); ++v) {
            require(std::isfinite(masses_(v)) && masses_(v) >= Scalar(0), "mass of vertex ", v, " = ", masses_(v),
                    " kg, expected >= 0");
        }
    }

    Scalar time_step() const { return time_step_; }
    const VectorX<Scalar>& masses() const { return masses_; }

    /// Placement x = p + A d and inertial target xt of the step; both must outlive the solve.
    void set_step(const Placement<Scalar>& placement, const Matrix3X<Scalar>& target) {
        placement_ = &placement;
        target_ = &target;
    }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E&) const {
        Scalar sum(0);
        for (Index v = 0; v < d.cols(); ++v) {
            if (masses_(v) > Scalar(0)) {
                sum += masses_(v) * offset(d, v).squaredNorm();
            }
        }
        return Scalar(0.5) * sum / (time_step_ * time_step_);
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) const {
        add_energy_and_gradient(d, gradient, executor);
    }

    template <Executor E>
    Scalar add_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E&) const {
        Scalar sum(0);
        for (Index v = 0; v < d.cols(); ++v) {
            if (masses_(v) > Scalar(0)) {
                const Vector3<Scalar> r = offset(d, v);
                sum += masses_(v) * r.squaredNorm();
                gradient.col(v) += stiffness(v) * placement_->pull_back(v, r);
            }
        }
        return Scalar(0.5) * sum / (time_step_ * time_step_);
    }

    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&) const {}

    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) {
        free_vertices_ = prescribed.free_vertices();
        diagonal_ranks_.resize(free_vertices_.size());
        for (size_t j = 0; j < free_vertices_.size(); ++j) {
            diagonal_ranks_[j] = pattern.rank(Index(j), static_cast<std::int32_t>(j));
        }
    }

    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>&, PsdFilter, BlockMatrix<Scalar>& hessian, const E&) const {
        for (size_t j = 0; j < free_vertices_.size(); ++j) {
            const Index v = free_vertices_[j];
            Matrix3<Scalar> block = Matrix3<Scalar>::Identity();
            if (placement_->has_maps()) {
                block = placement_->map(v).transpose() * placement_->map(v);
            }
            hessian.add(Index(j), diagonal_ranks_[j], stiffness(v) * block);
        }
    }

private:
    Scalar stiffness(Index v) const { return masses_(v) / (time_step_ * time_step_); }
    Vector3<Scalar> offset(const Matrix3X<Scalar>& d, Index v) const {
        // the two large positions cancel first: the displacement keeps its digits
        return (placement_->origins.col(v) - target_->col(v)) + placement_->displacement(v, d.col(v));
    }

    VectorX<Scalar> masses_;
    Scalar time_step_;
    const Placement<Scalar>* placement_ = nullptr;
    const Matrix3X<Scalar>* target_ = nullptr;
    std::vector<std::int32_t> free_vertices_;
    std::vector<std::int32_t> diagonal_ranks_;
};

}  // namespace softtissue
