// SPDX-License-Identifier: MIT
// Counts the edges of a triangle list, without help of the library.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/surface_mesh.hpp>

#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace softtissue_test {

struct SurfaceTopology {
    int vertices = 0;  // used by a triangle
    int edges = 0;
    int triangles = 0;
    int boundary = 0;  // edges with one triangle
    int bad = 0;       // edges run through twice in the same direction

    int euler() const { return vertices - edges + triangles; }
    bool is_closed() const { return boundary == 0 && bad == 0; }
};

template <class Corner>
SurfaceTopology surface_topology(int count, const Corner& corner) {
    std::map<std::pair<int, int>, int> directed;
    std::set<int> used;
    for (int t = 0; t < count; ++t) {
        for (int k = 0; k < 3; ++k) {
            ++directed[{corner(t, k), corner(t, (k + 1) % 3)}];
            used.insert(corner(t, k));
        }
    }
    SurfaceTopology result;
    result.vertices = int(used.size());
    result.triangles = count;
    for (const auto& [edge, times] : directed) {
        const bool has_twin = directed.count({edge.second, edge.first}) > 0;
        result.bad += times > 1 ? 1 : 0;
        result.boundary += has_twin ? 0 : 1;
        result.edges += has_twin && edge.first > edge.second ? 0 : 1;
    }
    return result;
}

inline SurfaceTopology surface_topology(const softtissue::SurfaceMesh& mesh) {
    return surface_topology(int(mesh.triangles.size()),
                            [&mesh](int t, int k) { return mesh.triangles[std::size_t(t)][std::size_t(k)]; });
}
inline SurfaceTopology surface_topology(const softtissue::Triangles& triangles) {
    return surface_topology(int(triangles.cols()), [&triangles](int t, int k) { return int(triangles(k, t)); });
}

}  // namespace softtissue_test
