// SPDX-License-Identifier: MIT
/// @file
/// Turns any mesh of half a mirror-symmetric surface into well-shaped triangles of wanted size on that surface.
///
/// What        rounds of: split long edges, collapse short ones, flip edges towards six neighbours, slide vertices to
///             the weighted middle of their surroundings, project them back to distance = 0; at last flip every
///             edge that faces more than 180 degrees, so that small angles grow.
/// Shapes      half mesh in x >= 0 with its boundary on x = 0; the boundary stays there.
///             target_length(x) [m] is the wanted edge length.
/// Valid       input near the surface, manifold, closed but for the boundary. Every step keeps manifold, genus and
///             orientation (HalfMesh).
/// Source      the scheme of Botsch and Kobbelt 2004, "A Remeshing Approach to Multiresolution Modeling", sec. 4.
/// Departs     sizes vary over the surface; collapses and flips are checked against the surface's own normal.
/// Cost        about 8 evaluations of the distance per vertex and round
/// Tests       tests/unit/model/isotropic_remesh_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/half_mesh.hpp>
#include <softtissue/model/smooth_solid.hpp>
#include <softtissue/model/surface_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace softtissue {

template <class Distance, class TargetLength>
class IsotropicRemesher {
public:
    IsotropicRemesher(SurfaceMesh mesh, const Distance& distance, const TargetLength& target_length)
        : distance_(distance), target_length_(target_length), mesh_(std::move(mesh)) {
        normals_.resize(size_t(mesh_.num_vertices()));
        for (int v = 0; v < mesh_.num_vertices(); ++v) {
            project(v);
        }
    }

    SurfaceMesh operator()(int rounds) {
        const auto improves_valence = [this](int a, int b, int c, int d) { return is_more_regular(a, b, c, d); };
        const auto improves_angles = [this](int a, int b, int c, int d) { return faces_obtuse(a, b, c, d); };
        for (int round = 0; round < rounds; ++round) {
            split_long_edges();
            collapse_short_edges();
            flip_edges(improves_valence);
            slide();
        }
        for (int round = 0; round < 5; ++round) {
            flip_edges(improves_angles);
            slide();
        }
        flip_edges(improves_angles);
        return mesh_.compacted();
    }

private:
    static constexpr double longest = 4.0 / 3.0;   // of the wanted length: halves are then no shorter than allowed
    static constexpr double shortest = 4.0 / 5.0;  // of the wanted length
    static constexpr double near = 5e-3;           // of the wanted length: a Newton step then leaves about its square

    double wanted_length(int a, int b) const {
        return target_length_(Vector3<double>(0.5 * (mesh_.position(a) + mesh_.position(b))));
    }

    /// Newton steps along the gradient until the last one started near; vertices of the boundary stay in x = 0.
    void project(int v) {
        Vector3<double>& x = mesh_.position(v);
        const double length = target_length_(x);
        bool is_near = false;
        for (int step = 0; step < 3 && !is_near; ++step) {
            const DistanceSample sample = sample_distance(distance_, x);
            const double slope2 = sample.gradient.squaredNorm();
            const double limit = 0.5 * length / std::sqrt(slope2);
            x -= std::clamp(sample.value / slope2, -limit, limit) * sample.gradient;
            if (mesh_.is_on_boundary(v)) {
                x(0) = 0.0;
            }
            normals_[size_t(v)] = sample.gradient / std::sqrt(slope2);
            is_near = std::abs(sample.value) < near * length;
        }
    }

    /// Twice the area of (a, b, c) seen along `normal`, relative to its longest edge squared: 0.87 at best.
    static double facing(const Vector3<double>& a, const Vector3<double>& b, const Vector3<double>& c,
                         const Vector3<double>& normal) {
        const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        return (b - a).cross(c - a).dot(normal) / longest2;
    }

    void split_long_edges() {
        const size_t count = mesh_.num_triangles();
        for (size_t t = 0; t < count; ++t) {
            for (size_t k = 0; !mesh_.is_erased(t) && k < 3; ++k) {
                const auto [a, b] = mesh_.edge(t, k);
                if (mesh_.length(a, b) > longest * wanted_length(a, b)) {
                    const int middle = mesh_.split(a, b, int(t));
                    normals_.emplace_back();
                    project(middle);
                }
            }
        }
    }

    void collapse_short_edges() {
        for (size_t t = 0; t < mesh_.num_triangles(); ++t) {
            for (size_t k = 0; !mesh_.is_erased(t) && k < 3; ++k) {
                auto [a, b] = mesh_.edge(t, k);
                if (mesh_.length(a, b) >= shortest * wanted_length(a, b)) {
                    continue;
                }
                if (mesh_.is_on_boundary(b) && !mesh_.is_on_boundary(a)) {
                    std::swap(a, b);
                }
                const Vector3<double> x = merged_position(a, b);
                const Vector3<double> normal = (normals_[size_t(a)] + normals_[size_t(b)]).normalized();
                if (mesh_.can_collapse(a, b) && keeps_shape(a, b, x, normal) && keeps_shape(b, a, x, normal)) {
                    mesh_.position(a) = x;
                    mesh_.collapse(a, b);
                    project(a);
                }
            }
        }
    }

    Vector3<double> merged_position(int a, int b) const {
        if (mesh_.is_on_boundary(a) && !mesh_.is_on_boundary(b)) {
            return mesh_.position(a);
        }
        return 0.5 * (mesh_.position(a) + mesh_.position(b));
    }

    /// No triangle around `v`, moved to x, turns away from the surface, and no edge becomes long.
    bool keeps_shape(int v, int other, const Vector3<double>& x, const Vector3<double>& normal) const {
        for (const int t : mesh_.star(v)) {
            std::array<Vector3<double>, 3> corners;
            bool vanishes = false;
            for (size_t k = 0; k < 3; ++k) {
                const int w = mesh_.triangle(t)[k];
                vanishes = vanishes || w == other;
                corners[k] = w == v ? x : mesh_.position(w);
                if (w != v && w != other && (corners[k] - x).norm() > longest * target_length_(x)) {
                    return false;
                }
            }
            if (!vanishes && facing(corners[0], corners[1], corners[2], normal) < 0.1) {
                return false;
            }
        }
        return true;
    }

    /// Edge a-b with opposite corners c, d becomes c-d where `improves(a, b, c, d)`.
    template <class Improves>
    void flip_edges(const Improves& improves) {
        for (size_t t = 0; t < mesh_.num_triangles(); ++t) {
            for (size_t k = 0; !mesh_.is_erased(t) && k < 3; ++k) {
                const auto [a, b] = mesh_.edge(t, k);
                const int other = mesh_.triangle_with(b, a);
                if (other < 0) {
                    continue;
                }
                const int c = mesh_.opposite(int(t), a, b);
                const int d = mesh_.opposite(other, a, b);
                if (!mesh_.can_flip(c, d) || !improves(a, b, c, d)) {
                    continue;
                }
                const Vector3<double> normal = (normals_[size_t(a)] + normals_[size_t(b)]).normalized();
                if (facing(mesh_.position(a), mesh_.position(d), mesh_.position(c), normal) > 0.15 &&
                    facing(mesh_.position(b), mesh_.position(c), mesh_.position(d), normal) > 0.15) {
                    mesh_.flip(int(t), other, a, b, c, d);
                }
            }
        }
    }

    /// The flip brings the number of triangles around the four vertices nearer to six (to three on the boundary,
    /// where the mirror image has as many).
    bool is_more_regular(int a, int b, int c, int d) const {
        const auto excess = [this](int v, int change) {
            const bool is_halved = mesh_.is_on_boundary(v);
            const int e = int(mesh_.star(v).size()) + change - (is_halved ? 3 : 6);
            return is_halved ? 4 * e * e : e * e;
        };
        return excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1) <
               excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
    }

    /// The two angles that face the edge sum to clearly more than 180 degrees, so that no flip is ever undone.
    bool faces_obtuse(int a, int b, int c, int d) const {
        const auto cotangent = [&](int at) {
            const Vector3<double> u = mesh_.position(a) - mesh_.position(at);
            const Vector3<double> v = mesh_.position(b) - mesh_.position(at);
            return u.dot(v) / u.cross(v).norm();
        };
        return cotangent(c) + cotangent(d) < -0.01;
    }

    void slide() {
        for (int v = 0; v < mesh_.num_vertices(); ++v) {
            if (!mesh_.star(v).empty()) {
                const Vector3<double> towards =
                    (mesh_.is_on_boundary(v) ? boundary_middle(v) : inner_middle(v)) - mesh_.position(v);
                const Vector3<double>& n = normals_[size_t(v)];
                mesh_.position(v) += towards - n.dot(towards) * n;
                project(v);
            }
        }
    }

    /// Mean of the triangles around v, by area counted in wanted sizes.
    Vector3<double> inner_middle(int v) const {
        Vector3<double> sum = Vector3<double>::Zero();
        double total = 0.0;
        for (const int t : mesh_.star(v)) {
            const HalfMesh::Triangle& c = mesh_.triangle(t);
            const Vector3<double> middle = (mesh_.position(c[0]) + mesh_.position(c[1]) + mesh_.position(c[2])) / 3.0;
            const double wanted = target_length_(middle);
            const double weight = mesh_.normal(t).norm() / (wanted * wanted);
            sum += weight * middle;
            total += weight;
        }
        return sum / total;
    }

    /// Mean of the two boundary edges at v, by length counted in wanted lengths.
    Vector3<double> boundary_middle(int v) const {
        Vector3<double> sum = Vector3<double>::Zero();
        double total = 0.0;
        for (const int w : mesh_.neighbours(v)) {
            if (mesh_.is_boundary_edge(v, w)) {
                const double weight = mesh_.length(v, w) / wanted_length(v, w);
                sum += weight * 0.5 * (mesh_.position(v) + mesh_.position(w));
                total += weight;
            }
        }
        return sum / total;
    }

    const Distance& distance_;
    const TargetLength& target_length_;
    HalfMesh mesh_;
    std::vector<Vector3<double>> normals_;  // of the surface, where the vertex was last projected
};

}  // namespace softtissue
