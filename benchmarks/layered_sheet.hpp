// SPDX-License-Identifier: MIT
/// @file
/// Two layers of prisms over a wavy sheet of n x n squares, 4 n^2 prisms; the lowest vertices are prescribed.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace benchmarks {

template <class S>
struct LayeredSheet {
    softtissue::CellMesh<softtissue::Prism6, S> mesh;
    std::vector<std::int32_t> prescribed;

    explicit LayeredSheet(softtissue::Index n) {
        using softtissue::Index;
        const Index per_layer = (n + 1) * (n + 1);
        mesh.rest_positions.resize(3, 3 * per_layer);
        for (Index layer = 0; layer < 3; ++layer) {
            for (Index i = 0; i <= n; ++i) {
                for (Index j = 0; j <= n; ++j) {
                    const double x = double(i) / double(n), y = double(j) / double(n);
                    mesh.rest_positions.col(layer * per_layer + i * (n + 1) + j) << S(x), S(y),
                        S(0.1 * std::sin(6 * x) * std::cos(5 * y) + 0.01 * double(layer));
                }
            }
        }
        mesh.cells.resize(6, 4 * n * n);
        Index cell = 0;
        for (Index layer = 0; layer < 2; ++layer) {
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < n; ++j) {
                    const Index v = layer * per_layer + i * (n + 1) + j;
                    for (const auto& corners :
                         {std::array{v, v + n + 1, v + 1}, std::array{v + 1, v + n + 1, v + n + 2}}) {
                        for (Index k = 0; k < 3; ++k) {
                            mesh.cells(k, cell) = std::int32_t(corners[size_t(k)]);
                            mesh.cells(k + 3, cell) = std::int32_t(corners[size_t(k)] + per_layer);
                        }
                        ++cell;
                    }
                }
            }
        }
        for (Index v = 0; v < per_layer; ++v) {
            prescribed.push_back(std::int32_t(v));
        }
    }

    /// Small and smooth, so that no cell is inverted.
    softtissue::Matrix3X<S> displacement() const {
        softtissue::Matrix3X<S> d(3, mesh.num_vertices());
        for (softtissue::Index v = 0; v < d.cols(); ++v) {
            for (int k = 0; k < 3; ++k) {
                d(k, v) = S(2e-3) * S(std::sin(20 * double(mesh.rest_positions((k + 1) % 3, v))));
            }
        }
        return d;
    }
};

}  // namespace benchmarks
