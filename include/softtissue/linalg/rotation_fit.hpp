// SPDX-License-Identifier: MIT
/// @file
/// The nearest rotation of many 3x3 matrices.
///
/// What        the local step of projective methods: R_c = argmin |F_c - R|, det R_c = +1, for a whole mesh.
/// Shapes      gradients, rotations 3 x 3n: matrix c in the columns 3c to 3c + 2; they may be the same array.
/// Valid       every finite F; see linalg/polar.hpp for where R is not unique
/// Source      Bouaziz et al. 2014; Komaritzan & Botsch 2018
/// Tests       tests/unit/linalg/rotation_fit_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/polar.hpp>

namespace softtissue {

/// Writes one rotation per matrix; allocates nothing. Same bits for every executor.
template <RealScalar S, Executor E = SequentialExecutor>
void fit_rotations_into(const Matrix3X<S>& gradients, Matrix3X<S>& rotations, const E& executor = {}) {
    require(gradients.cols() % 3 == 0, "rotation fit: ", gradients.cols(), " columns, expected three per matrix");
    rotations.resize(3, gradients.cols());
    executor.for_each_range(gradients.cols() / 3, [&](Index begin, Index end) {
        for (Index c = begin; c < end; ++c) {
            const Matrix3<S> F = gradients.template middleCols<3>(3 * c);
            rotations.template middleCols<3>(3 * c) = polar_rotation(F);
        }
    });
}

}  // namespace softtissue
