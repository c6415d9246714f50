// SPDX-License-Identifier: MIT
/// @file
/// The surface of a tetrahedral mesh.
///
/// What        the faces that one cell has, 3 x m, outward for cells of positive volume; in the order of their cells.
/// Shapes      tets 4 x cells; faces of a cell: 123, 032, 013, 021
/// Cost        O(cells log cells)
/// Tests       tests/unit/mesh/tet_surface_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace softtissue {

inline Triangles surface_of_tets(const Connectivity<4>& tets) {
    constexpr std::array<std::array<Index, 3>, 4> faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    using Corners = std::array<std::int32_t, 3>;
    const auto corners = [&](Index tet, const std::array<Index, 3>& face) {
        return Corners{tets(face[0], tet), tets(face[1], tet), tets(face[2], tet)};
    };
    const auto sorted = [](Corners c) {
        std::sort(c.begin(), c.end());
        return c;
    };
    std::map<Corners, int> count;
    for (Index t = 0; t < tets.cols(); ++t) {
        for (const auto& face : faces) {
            ++count[sorted(corners(t, face))];
        }
    }
    std::vector<std::int32_t> surface;
    for (Index t = 0; t < tets.cols(); ++t) {
        for (const auto& face : faces) {
            const Corners c = corners(t, face);
            if (count[sorted(c)] == 1) {
                surface.insert(surface.end(), c.begin(), c.end());
            }
        }
    }
    return Eigen::Map<const Triangles>(surface.data(), 3, Index(surface.size() / 3));
}

}  // namespace softtissue
