// SPDX-License-Identifier: MIT
// Symmetric matrices of 3x3 blocks: springs of random stiffness between vertices of a lattice, each held by an anchor.
#pragma once

#include <softtissue/sparse/block_matrix.hpp>
#include <softtissue/testing/random_states.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

/// width x height vertices, springs along the sides and one diagonal of each square; `anchor` < 0 makes it indefinite. Every
/// seventh vertex is alone.
template <class S>
BlockMatrix<S> spring_lattice(Index width, Index height, double anchor, RandomGenerator& random) {
    const Index n = width * height;
    const auto is_alone = [](Index v) { return v % 7 == 3; };
    std::vector<std::pair<Index, Index>> springs;
    for (Index v = 0; v < n; ++v) {
        for (const Index u : {v + 1, v + width, v + width + 1}) {
            const bool wraps = u != v + width && v % width == width - 1;
            if (u < n && !wraps && !is_alone(u) && !is_alone(v)) {
                springs.emplace_back(v, u);
            }
        }
    }
    std::vector<std::vector<std::int32_t>> neighbours(static_cast<size_t>(n));
    for (const auto& [v, u] : springs) {
        neighbours[size_t(v)].push_back(std::int32_t(u));
        neighbours[size_t(u)].push_back(std::int32_t(v));
    }
    BlockMatrix<S> A{BlockPattern(std::move(neighbours))};
    const auto add = [&](Index row, Index column, const Matrix3<S>& block) {
        A.add(column, A.pattern().rank(column, std::int32_t(row)), block);
    };
    for (Index v = 0; v < n; ++v) {
        add(v, v, S(anchor) * Matrix3<S>::Identity());
    }
    for (const auto& [v, u] : springs) {
        const Vector3<S> t = random_normal<Vector3<S>>(random);
        const Matrix3<S> stiffness = t * t.transpose();
        add(v, v, stiffness);
        add(u, u, stiffness);
        add(v, u, -stiffness);
        add(u, v, -stiffness);
    }
    return A;
}

template <class S>
VectorX<S> random_vector(Index size, RandomGenerator& random) {
    return VectorX<S>::NullaryExpr(size, [&] { return S(random.normal()); });
}

}  // namespace softtissue_test
