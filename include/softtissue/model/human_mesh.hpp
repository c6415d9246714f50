// SPDX-License-Identifier: MIT
/// @file
/// The skin of the procedural human as a closed triangle mesh.
///
/// What        half of HumanSolid polygonised, remeshed and mirrored: exactly symmetric, closed, genus 0.
/// Shapes      vertices 3 x n [m]; faces 3 x m, counter-clockwise seen from outside; mirror[v] is the vertex at the
///             mirrored place, v itself on the mid-line (x = 0 exactly). n is about 7,000.
///             Edges are about 18 mm long, 8 to 12 mm on head, hands and feet.
/// Cost        about 0.7 s
/// Tests       tests/unit/model/human_mesh_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/model/isotropic_remesh.hpp>
#include <softtissue/model/marching_tetrahedra.hpp>
#include <softtissue/model/surface_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace softtissue {

/// Zero up to `from`, one from `to`, twice continuously differentiable between.
inline double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
}

struct HumanMesh {
    Matrix3X<double> vertices;
    Triangles faces;
    std::vector<Index> mirror;

    Index num_vertices() const { return vertices.cols(); }

    /// The vertices around each vertex, ascending.
    std::vector<std::vector<Index>> neighbours() const {
        std::vector<std::vector<Index>> result(static_cast<size_t>(num_vertices()));
        for (Index f = 0; f < faces.cols(); ++f) {
            for (int k = 0; k < 3; ++k) {
                result[size_t(faces(k, f))].push_back(faces((k + 1) % 3, f));
            }
        }
        for (std::vector<Index>& around : result) {
            std::sort(around.begin(), around.end());
        }
        return result;
    }

    /// `rounds` times the mean of each vertex' neighbours, for any per-vertex values (columns).
    template <class Values>
    Values smoothed(Values values, int rounds) const {
        const std::vector<std::vector<Index>> around = neighbours();
        for (int round = 0; round < rounds; ++round) {
            const Values before = values;
            for (Index v = 0; v < num_vertices(); ++v) {
                values.col(v).setZero();
                for (const Index w : around[size_t(v)]) {
                    values.col(v) += before.col(w);
                }
                values.col(v) /= double(around[size_t(v)].size());
            }
        }
        return values;
    }
};

namespace detail {

/// The half in x >= 0 and its mirror image as one mesh.
inline HumanMesh mirrored_whole(const SurfaceMesh& half) {
    const Index count = Index(half.vertices.size());
    std::vector<Index> image(size_t(count), 0);
    Index total = count;
    for (Index v = 0; v < count; ++v) {
        image[size_t(v)] = half.vertices[size_t(v)](0) > 0.0 ? total++ : v;
    }
    HumanMesh whole{Matrix3X<double>(3, total), Triangles(3, 2 * Index(half.triangles.size())),
                    std::vector<Index>(size_t(total))};
    for (Index v = 0; v < count; ++v) {
        const Index w = image[size_t(v)];
        whole.vertices.col(w) = mirrored(half.vertices[size_t(v)]);
        whole.vertices.col(v) = half.vertices[size_t(v)];
        whole.mirror[size_t(v)] = w;
        whole.mirror[size_t(w)] = v;
    }
    for (Index t = 0; t < Index(half.triangles.size()); ++t) {
        for (int k = 0; k < 3; ++k) {
            const int v = half.triangles[size_t(t)][size_t(k)];
            whole.faces(k, 2 * t) = v;
            whole.faces(2 - k, 2 * t + 1) = std::int32_t(image[size_t(v)]);
        }
    }
    return whole;
}

}  // namespace detail

/// Builds the skin.
inline HumanMesh make_human_mesh() {
    const HumanSolid solid;
    const auto edge_length = [](const Vector3<double>& x) {
        const double head = smooth_step(1.45, 1.53, x(1));
        const double hand = smooth_step(0.48, 0.56, x(0));
        const double foot = smooth_step(0.14, 0.06, x(1));
        const double face = head * smooth_step(0.02, 0.07, x(2));
        return 0.0184 * (1.0 - std::max({0.33 * head + 0.22 * face, 0.42 * hand, 0.34 * foot}));
    };
    // The lattice is wider than the body; its odd numbers keep lattice points off the round measures of the body.
    const SurfaceMesh raw = marching_tetrahedra(solid, {0.0, -0.0237, -0.1913}, 0.0127, {55, 140, 31});
    return detail::mirrored_whole(IsotropicRemesher(raw, solid, edge_length)(8));
}

}  // namespace softtissue
