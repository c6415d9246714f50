// SPDX-License-Identifier: MIT
// The patch test: a boundary that moves affinely makes the inside follow affinely, whatever the mesh and the material.
#pragma once

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/solver/continuation.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>

#include <support/solid_block.hpp>

namespace softtissue_test {

struct PatchResult {
    bool succeeded = false;
    double error = 0;        ///< largest distance of an inner vertex from the affine image of its rest position [m]
    double strain_error = 0; ///< largest |F - G| of a cell when every vertex is put on its affine image
    Index num_inner = 0;
};

template <class ElementType, class Field>
PatchResult patch_test(const BlockOptions& options, const Field& field) {
    const auto block = solid_block<ElementType>(options);
    const Matrix3X<double>& X = block.mesh.rest_positions;
    RandomGenerator random(options.seed + 100);
    const Matrix3<double> G = Matrix3<double>::Identity() + 0.15 * random_normal<Matrix3<double>>(random);
    const Matrix3X<double> affine = ((G * X).colwise() + random_normal<Vector3<double>>(random)) - X;

    ElasticEnergy<ElementType, Field> elastic(block.mesh, field);
    PatchResult result;
    for (Index c = 0; c < elastic.num_cells(); ++c) {
        result.strain_error = std::max(result.strain_error, (elastic.deformation_gradient(affine, c) - G).norm());
    }
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(X.cols(), block.surface), executor, elastic);
    DirectSolver<double> linear_solver;
    Matrix3X<double> d = Matrix3X<double>::Zero(3, X.cols());
    result.succeeded = follow_boundary(objective, linear_solver, d, affine).succeeded();
    result.error = (d - affine).colwise().norm().maxCoeff();
    result.num_inner = objective.prescribed().num_free();
    return result;
}

}  // namespace softtissue_test
