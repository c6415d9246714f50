// SPDX-License-Identifier: MIT
// A flat square of triangles and a cube of tets, for operators on meshes.
#pragma once

#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/testing/random_states.hpp>

#include <vector>

namespace softtissue_test {

using namespace softtissue;

struct SquareMesh {
    Matrix3X<double> positions;
    Triangles triangles;
};

/// The unit square z = 0 in n x n pairs of triangles; vertex (i, j) is i + (n + 1) j.
inline SquareMesh make_square(int n) {
    SquareMesh mesh{Matrix3X<double>(3, (n + 1) * (n + 1)), Triangles(3, 2 * n * n)};
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            mesh.positions.col(i + (n + 1) * j) = Vector3<double>(i, j, 0) / n;
        }
    }
    Index t = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const int v = i + (n + 1) * j;
            mesh.triangles.col(t++) << v, v + 1, v + n + 2;
            mesh.triangles.col(t++) << v, v + n + 2, v + n + 1;
        }
    }
    return mesh;
}

inline bool is_on_cube_surface(const Vector3<double>& p) {
    return (p.array() == 0 || p.array() == 1).any();
}

/// The unit cube: n layers of prisms on the square, cut into tets, with noise on its inner vertices.
inline CellMesh<Tet4, double> make_cube(int n, RandomGenerator& random) {
    const SquareMesh square = make_square(n);
    const Index per_level = square.positions.cols();
    CellMesh<Prism6, double> prisms{Matrix3X<double>(3, per_level * (n + 1)),
                                    Connectivity<6>(6, square.triangles.cols() * n)};
    for (int level = 0; level <= n; ++level) {
        for (Index v = 0; v < per_level; ++v) {
            Vector3<double> p = square.positions.col(v) + Vector3<double>(0, 0, double(level) / n);
            if (!is_on_cube_surface(p)) {
                p += random_normal<Vector3<double>>(random) * 0.05 / n;
            }
            prisms.rest_positions.col(per_level * level + v) = p;
        }
    }
    for (int level = 0; level < n; ++level) {
        for (Index t = 0; t < square.triangles.cols(); ++t) {
            const Index c = square.triangles.cols() * level + t;
            const auto below = std::int32_t(per_level * level);
            const auto above = std::int32_t(per_level * (level + 1));
            prisms.cells.col(c) << square.triangles.col(t).array() + below, square.triangles.col(t).array() + above;
        }
    }
    return split_prisms(prisms);
}

inline std::vector<std::int32_t> cube_surface(const CellMesh<Tet4, double>& cube) {
    std::vector<std::int32_t> vertices;
    for (Index v = 0; v < cube.num_vertices(); ++v) {
        if (is_on_cube_surface(cube.rest_positions.col(v))) {
            vertices.push_back(std::int32_t(v));
        }
    }
    return vertices;
}

}  // namespace softtissue_test
