// SPDX-License-Identifier: MIT
/// @file
/// Polygon mesh of the zero surface of a function: manifold by construction, whatever the function.
///
/// What        samples on a cubic lattice, each cube cut into six tetrahedra along its main diagonal, one or two
///             triangles in every tetrahedron whose corners differ in sign (zero counts as outside).
/// Shapes      lattice of counts[0] x counts[1] x counts[2] points from `corner`, `spacing` [m] apart.
///             Where the surface leaves the lattice the mesh has a boundary, which lies in the lattice's face.
/// Valid       every function. Features smaller than the spacing may be lost. The triangles are badly shaped.
/// Cost        one evaluation per lattice point.
/// Tests       tests/unit/model/marching_tetrahedra_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/surface_mesh.hpp>

#include <array>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

namespace softtissue {

template <class Distance>
class MarchingTetrahedra {
public:
    MarchingTetrahedra(const Distance& distance, const Vector3<double>& corner, double spacing,
                       const std::array<int, 3>& counts)
        : corner_(corner), spacing_(spacing), counts_(counts) {
        values_.reserve(size_t(counts[0]) * size_t(counts[1]) * size_t(counts[2]));
        for (int k = 0; k < counts[2]; ++k) {
            for (int j = 0; j < counts[1]; ++j) {
                for (int i = 0; i < counts[0]; ++i) {
                    values_.push_back(distance(position({i, j, k})));
                }
            }
        }
    }

    SurfaceMesh operator()() {
        mesh_ = {};
        edge_vertices_.clear();
        for (int k = 0; k + 1 < counts_[2]; ++k) {
            for (int j = 0; j + 1 < counts_[1]; ++j) {
                for (int i = 0; i + 1 < counts_[0]; ++i) {
                    cube({i, j, k});
                }
            }
        }
        return std::move(mesh_);
    }

private:
    using Point = std::array<int, 3>;

    void cube(const Point& p) {
        constexpr std::array<std::array<int, 3>, 6> orders{
            {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
        for (const std::array<int, 3>& order : orders) {
            std::array<Point, 4> corners{p, p, p, p};
            for (size_t c = 1; c < 4; ++c) {
                corners[c] = corners[c - 1];
                ++corners[c][size_t(order[c - 1])];
            }
            tetrahedron(corners);
        }
    }

    void tetrahedron(const std::array<Point, 4>& corners) {
        std::array<Point, 4> inside{};
        std::array<Point, 4> outside{};
        size_t ins = 0;
        size_t outs = 0;
        for (const Point& c : corners) {
            (value(c) < 0.0 ? inside[ins++] : outside[outs++]) = c;
        }
        if (ins == 1) {
            triangle({inside[0], inside[0], inside[0]}, {outside[0], outside[1], outside[2]});
        } else if (ins == 3) {
            triangle({inside[0], inside[1], inside[2]}, {outside[0], outside[0], outside[0]});
        } else if (ins == 2) {
            triangle({inside[0], inside[0], inside[1]}, {outside[0], outside[1], outside[1]});
            triangle({inside[0], inside[1], inside[1]}, {outside[0], outside[1], outside[0]});
        }
    }

    /// The triangle on edges inside[i]-outside[i]. Which way round is decided on the edges' middles, in integers.
    void triangle(const std::array<Point, 3>& inside, const std::array<Point, 3>& outside) {
        std::array<Point, 3> middle{};
        Point outwards{};
        for (size_t i = 0; i < 3; ++i) {
            for (size_t c = 0; c < 3; ++c) {
                middle[i][c] = inside[i][c] + outside[i][c];
                outwards[c] += outside[i][c] - inside[i][c];
            }
        }
        Point a{};
        Point b{};
        for (size_t c = 0; c < 3; ++c) {
            a[c] = middle[1][c] - middle[0][c];
            b[c] = middle[2][c] - middle[0][c];
        }
        const int side = outwards[0] * (a[1] * b[2] - a[2] * b[1]) + outwards[1] * (a[2] * b[0] - a[0] * b[2]) +
                         outwards[2] * (a[0] * b[1] - a[1] * b[0]);
        const size_t second = side > 0 ? 1 : 2;
        mesh_.triangles.push_back({edge_vertex(inside[0], outside[0]), edge_vertex(inside[second], outside[second]),
                                   edge_vertex(inside[3 - second], outside[3 - second])});
    }

    int edge_vertex(const Point& inside, const Point& outside) {
        const size_t a = number(inside);
        const size_t b = number(outside);
        const size_t key = a * values_.size() + b;
        const auto [entry, is_new] = edge_vertices_.try_emplace(key, int(mesh_.vertices.size()));
        if (is_new) {
            const double t = values_[a] / (values_[a] - values_[b]);
            mesh_.vertices.push_back(position(inside) + t * (position(outside) - position(inside)));
        }
        return entry->second;
    }

    size_t number(const Point& p) const {
        return (size_t(p[2]) * size_t(counts_[1]) + size_t(p[1])) * size_t(counts_[0]) + size_t(p[0]);
    }
    double value(const Point& p) const { return values_[number(p)]; }
    Vector3<double> position(const Point& p) const { return corner_ + spacing_ * Vector3<double>(p[0], p[1], p[2]); }

    Vector3<double> corner_;
    double spacing_;
    std::array<int, 3> counts_;
    std::vector<double> values_;
    std::unordered_map<size_t, int> edge_vertices_;
    SurfaceMesh mesh_;
};

/// Mesh of distance = 0 inside the lattice.
template <class Distance>
SurfaceMesh marching_tetrahedra(const Distance& distance, const Vector3<double>& corner, double spacing,
                                const std::array<int, 3>& counts) {
    return MarchingTetrahedra<Distance>(distance, corner, spacing, counts)();
}

}  // namespace softtissue
