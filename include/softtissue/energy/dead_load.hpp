// SPDX-License-Identifier: MIT
/// @file
/// Constant forces on vertices.
///
/// Equation    E(d) = - sum_i f_i . (A_i d_i)
/// Shapes      forces 3 x vertices [N], in the world; d 3 x vertices [m]
/// Source      Romero et al. 2020, eq. (3), f_e
/// Tests       tests/unit/energy/dead_load_test.cpp, tests/laws/energy_laws_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
class DeadLoad {
public:
    using Scalar = S;

    explicit DeadLoad(Matrix3X<Scalar> forces) : forces_(std::move(forces)) {}

    /// The forces act on x = p + A d; without a placement, x = rest + d. It must outlive the solve.
    void set_placement(const Placement<Scalar>& placement) { placement_ = &placement; }

    const Matrix3X<Scalar>& forces() const { return forces_; }
    void set_forces(ConstRef<Matrix3X<Scalar>> forces) { forces_ = forces; }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E&) const {
        Scalar work(0);
        for (Index v = 0; v < d.cols(); ++v) {
            work += force(v).dot(d.col(v));
        }
        return -work;
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E&) const {
        for (Index v = 0; v < d.cols(); ++v) {
            gradient.col(v) -= force(v);
        }
    }

    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&) const {}
    void bind(const PrescribedVertices&, const BlockPattern&) {}
    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>&, PsdFilter, BlockMatrix<Scalar>&, const E&) const {}

private:
    Vector3<Scalar> force(Index v) const {
        return placement_ ? placement_->pull_back(v, forces_.col(v)) : Vector3<Scalar>(forces_.col(v));
    }

    Matrix3X<Scalar> forces_;
    const Placement<Scalar>* placement_ = nullptr;
};

}  // namespace softtissue
