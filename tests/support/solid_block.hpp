// SPDX-License-Identifier: MIT
// Blocks of prisms or tets with as much disorder as a test asks for.
#pragma once

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/testing/random_states.hpp>

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

/// Sizes are fractions of an edge of the n x n x layers grid.
struct BlockOptions {
    int n = 3;
    int layers = 0;          ///< levels of prisms; 0: n
    double plan_noise = 0;   ///< of the triangles seen from above, the same in every level
    double level_noise = 0;  ///< a translation of each inner level: shears its prisms and changes their height
    double noise = 0;        ///< of every inner vertex
    double warp = 0;         ///< of the whole block, smooth [m]: the finer the mesh, the closer its cells to affine images
    std::uint64_t seed = 1;
};

template <class ElementType, class S>
struct SolidBlock {
    CellMesh<ElementType, S> mesh;
    std::vector<std::int32_t> surface;  ///< vertices on any of the six sides
    std::vector<std::int32_t> bottom;   ///< vertices of the lowest level
    std::vector<std::int32_t> top;      ///< vertices of the highest level
};

/// The unit cube; vertex (i, j, level) is i + (n + 1) (j + (n + 1) level).
template <class ElementType, class S = double>
SolidBlock<ElementType, S> solid_block(const BlockOptions& options = {}) {
    RandomGenerator random(options.seed);
    const int n = options.n;
    const int layers = options.layers > 0 ? options.layers : n;
    const int per_level = (n + 1) * (n + 1);
    const auto noise_of = [&](double size) { return Vector3<double>(size / n * random_normal<Vector3<double>>(random)); };
    Matrix3X<double> plan(3, per_level);
    for (int v = 0; v < per_level; ++v) {
        const int i = v % (n + 1), j = v / (n + 1);
        plan.col(v) << double(i) / n, double(j) / n, 0;
        if (i > 0 && i < n && j > 0 && j < n) {
            const Vector3<double> shift = noise_of(options.plan_noise);
            plan.col(v) += Vector3<double>(shift(0), shift(1), 0);
        }
    }
    SolidBlock<ElementType, S> block;
    CellMesh<Prism6, S> prisms{Matrix3X<S>(3, per_level * (layers + 1)), Connectivity<6>(6, 2 * n * n * layers)};
    for (int level = 0; level <= layers; ++level) {
        Vector3<double> offset(0, 0, double(level) / layers);
        if (level > 0 && level < layers) {
            offset += noise_of(options.level_noise);
        }
        for (int v = 0; v < per_level; ++v) {
            const int i = v % (n + 1), j = v / (n + 1);
            const std::int32_t vertex = v + per_level * level;
            const bool is_inside = i > 0 && i < n && j > 0 && j < n && level > 0 && level < layers;
            const Vector3<double> shift = is_inside ? noise_of(options.noise) : Vector3<double>(0, 0, 0);
            const Vector3<double> X = plan.col(v) + offset + shift;
            const Vector3<double> warp(std::sin(3 * X(1) + 2 * X(2)), std::sin(2 * X(0) - 3 * X(2)), std::sin(3 * X(0) + 2 * X(1)));
            prisms.rest_positions.col(vertex) = (X + options.warp * warp).template cast<S>();
            if (!is_inside) {
                block.surface.push_back(vertex);
            }
            if (level == 0) {
                block.bottom.push_back(vertex);
            }
            if (level == layers) {
                block.top.push_back(vertex);
            }
        }
    }
    Index c = 0;
    for (int level = 0; level < layers; ++level) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const int v = i + (n + 1) * j + per_level * level;
                const Vector3<std::int32_t> lower(v, v + 1, v + n + 2), upper(v, v + n + 2, v + n + 1);
                prisms.cells.col(c++) << lower, lower.array() + per_level;
                prisms.cells.col(c++) << upper, upper.array() + per_level;
            }
        }
    }
    if constexpr (std::is_same_v<ElementType, Tet4>) {
        block.mesh = split_prisms(prisms);
    } else {
        block.mesh = prisms;
    }
    return block;
}

/// Random displacements of about `size` [m].
template <class S>
Matrix3X<S> random_displacement(Index num_vertices, double size, RandomGenerator& random) {
    Matrix3X<S> d(3, num_vertices);
    for (Index k = 0; k < d.size(); ++k) {
        d.data()[k] = S(size * random.normal());
    }
    return d;
}

}  // namespace softtissue_test
