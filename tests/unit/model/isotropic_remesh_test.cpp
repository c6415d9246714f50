// SPDX-License-Identifier: MIT
#include <softtissue/model/isotropic_remesh.hpp>

#include <softtissue/model/marching_tetrahedra.hpp>

#include <support/surface_topology.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace softtissue;
using softtissue_test::surface_topology;

namespace {

double smallest_angle(const SurfaceMesh& mesh, size_t t) {
    double result = std::numbers::pi;
    for (size_t k = 0; k < 3; ++k) {
        const Vector3<double>& a = mesh.vertices[size_t(mesh.triangles[t][k])];
        const Vector3<double> u = mesh.vertices[size_t(mesh.triangles[t][(k + 1) % 3])] - a;
        const Vector3<double> v = mesh.vertices[size_t(mesh.triangles[t][(k + 2) % 3])] - a;
        result = std::min(result, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
    return result * 180.0 / std::numbers::pi;
}

}  // namespace

TEST_CASE("IsotropicRemesher: half an ellipsoid with finer triangles at one end") {
    const Ellipsoid ellipsoid{{0.0, 0.0, 0.0}, {0.6, 1.0, 0.5}};
    const auto distance = [&](const Vector3<double>& x) { return ellipsoid.distance(x); };
    const auto wanted = [](const Vector3<double>& x) { return 0.09 - 0.04 * std::clamp(x(1), 0.0, 1.0); };
    const SurfaceMesh raw = marching_tetrahedra(distance, {0.0, -1.11, -0.63}, 0.07, {10, 33, 19});
    const SurfaceMesh mesh = IsotropicRemesher(raw, distance, wanted)(6);

    const auto topology = surface_topology(mesh);
    CHECK(topology.bad == 0);
    CHECK(topology.euler() == 1);
    CHECK(size_t(topology.vertices) == mesh.vertices.size());

    int on_plane = 0;
    for (const Vector3<double>& x : mesh.vertices) {
        CHECK(x(0) >= 0.0);
        CHECK(std::abs(distance(x)) < 1e-6);
        on_plane += x(0) == 0.0 ? 1 : 0;
    }
    CHECK(on_plane == topology.boundary);

    std::vector<double> angles;
    double coarse = 0.0;
    double fine = 0.0;
    int coarse_count = 0;
    int fine_count = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        angles.push_back(smallest_angle(mesh, t));
        const Vector3<double>& a = mesh.vertices[size_t(mesh.triangles[t][0])];
        const double length = (a - mesh.vertices[size_t(mesh.triangles[t][1])]).norm();
        CHECK(mesh.normal(t).dot(a) > 0.0);  // outward: the origin is inside
        if (a(1) < -0.2) {
            coarse += length;
            ++coarse_count;
        } else if (a(1) > 0.6) {
            fine += length;
            ++fine_count;
        }
    }
    std::sort(angles.begin(), angles.end());
    CHECK(angles.front() > 15.0);
    CHECK(angles[angles.size() / 100] > 30.0);
    // Lengths are held between 4/5 and 4/3 of the wanted ones; their mean is near.
    CHECK(coarse / coarse_count == doctest::Approx(0.09).epsilon(0.15));
    CHECK(fine / fine_count == doctest::Approx(0.06).epsilon(0.2));
}
