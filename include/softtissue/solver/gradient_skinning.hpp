// SPDX-License-Identifier: MIT
/// @file
/// Gradient Skinning: every cell wants the blended rotation of its bones.
///
/// What        the network-free baseline of Neural Deformation Gradients, and a start for quasi-static solves.
/// Equation    Poisson reconstruction with the targets T_p = R_p, the blended rotation of the cell
/// Shapes      bones: one unit quaternion per joint (bone_quaternions); x 3 x vertices [m], prescribed columns given
/// Source      Nolte et al. 2026, eq. (11) and sec. 5.2.1; a volumetric Weber et al. 2007
/// Cost        30 flop and a square root per cell on top of the Poisson solve; allocates on the first call only
/// Tests       tests/unit/solver/gradient_skinning_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/cell_weights.hpp>
#include <softtissue/skinning/weights.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <span>
#include <vector>

namespace softtissue {

template <class ElementType, RealScalar S>
class GradientSkinning {
public:
    using Scalar = S;

    /// `poisson` must outlive this; `weights` are those of the mesh's vertices.
    GradientSkinning(PoissonReconstruction<ElementType, Scalar>& poisson, const CellMesh<ElementType, Scalar>& mesh,
                     const SkinningWeights<Scalar>& weights)
        : poisson_(&poisson), blended_(cell_weights(weights, mesh.cells)), rotations_(size_t(mesh.num_cells())) {
        require(mesh.num_cells() == poisson.num_cells(), "Gradient Skinning: mesh of ", mesh.num_cells(),
                " cells, expected ", poisson.num_cells());
    }

    const BlendedRotations<Scalar>& blended() const { return blended_; }

    /// R_p of every cell, valid until the next call.
    template <Executor E = SequentialExecutor>
    const std::vector<Matrix3<Scalar>>& rotations(std::span<const Quaternion<Scalar>> bones, const E& executor = {}) {
        blended_.rotations_into(bones, rotations_, executor);
        return rotations_;
    }

    /// Replaces the free columns of x.
    template <Executor E = SequentialExecutor>
    void solve_into(std::span<const Quaternion<Scalar>> bones, Matrix3X<Scalar>& x, const E& executor = {}) {
        rotations(bones, executor);
        targets_.resize(3, 3 * poisson_->num_cells());
        for (Index c = 0; c < poisson_->num_cells(); ++c) {
            targets_.template middleCols<3>(3 * c) = rotations_[size_t(c)];
        }
        poisson_->solve_into(targets_, x, executor);
    }

private:
    PoissonReconstruction<ElementType, Scalar>* poisson_;
    BlendedRotations<Scalar> blended_;
    std::vector<Matrix3<Scalar>> rotations_;
    Matrix3X<Scalar> targets_;
};

}  // namespace softtissue
