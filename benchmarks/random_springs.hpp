// SPDX-License-Identifier: MIT
/// @file
/// A stiffness with the pattern of flesh: springs of random 3x3 stiffness between all vertices that share a cell, and to the ground.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/stencil_assembly.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace benchmarks {

inline softtissue::BlockMatrix<double> random_springs(const softtissue::Connectivity<6>& cells,
                                                      const softtissue::PrescribedVertices& prescribed) {
    using namespace softtissue;
    std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
    StencilAssembly<6, double>(cells, prescribed.num_vertices()).add_neighbours(prescribed, neighbours);
    const BlockPattern pattern(std::move(neighbours));
    BlockMatrix<double> K(pattern);
    RandomGenerator random(1);
    for (Index v = 0; v < pattern.num_columns(); ++v) {
        const std::int32_t own = pattern.rank(v, std::int32_t(v));
        K.add(v, own, Matrix3<double>::Identity());
        for (const std::int32_t u : pattern.rows(v)) {
            if (u < v) {
                const Vector3<double> direction(random.normal(), random.normal(), random.normal());
                const Matrix3<double> block = direction * direction.transpose() + 0.1 * Matrix3<double>::Identity();
                K.add(v, own, block);
                K.add(u, pattern.rank(u, u), block);
                K.add(v, pattern.rank(v, u), -block);
                K.add(u, pattern.rank(u, std::int32_t(v)), -block);
            }
        }
    }
    return K;
}

}  // namespace benchmarks
