// SPDX-License-Identifier: MIT
#include <softtissue/model/marching_tetrahedra.hpp>

#include <support/surface_topology.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace softtissue;
using softtissue_test::surface_topology;
using softtissue_test::SurfaceTopology;

namespace {

double volume(const SurfaceMesh& mesh) {
    double six = 0.0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        six += mesh.normal(t).dot(mesh.vertices[size_t(mesh.triangles[t][0])]);
    }
    return six / 6.0;
}

}  // namespace

TEST_CASE("marching_tetrahedra: a sphere is closed, of genus 0, outward, of second-order volume") {
    const auto sphere = [](const Vector3<double>& x) { return x.norm() - 1.0; };
    double previous = 0.0;
    for (const int n : {16, 32}) {
        const SurfaceMesh mesh = marching_tetrahedra(sphere, {-1.21, -1.22, -1.23}, 2.46 / (n - 1), {n, n, n});
        const SurfaceTopology topology = surface_topology(mesh);
        CHECK(topology.is_closed());
        CHECK(topology.euler() == 2);
        CHECK(size_t(topology.vertices) == mesh.vertices.size());
        const double error = 4.0 / 3.0 * std::numbers::pi - volume(mesh);
        CHECK(error > 0.0);  // chords lie inside
        if (previous > 0.0) {
            CHECK(previous / error > 3.0);
        }
        previous = error;
    }
}

TEST_CASE("marching_tetrahedra: manifold for a function without any sense") {
    const auto noise = [](const Vector3<double>& x) {
        const double s = std::sin(127.1 * x(0) + 311.7 * x(1) + 74.7 * x(2)) * 43758.5453;
        return x.cwiseAbs().maxCoeff() > 3.5 ? 1.0 : s - std::floor(s) - 0.5;
    };
    const SurfaceMesh mesh = marching_tetrahedra(noise, {-4.0, -4.0, -4.0}, 1.0, {9, 9, 9});
    CHECK(mesh.triangles.size() > 500);
    CHECK(surface_topology(mesh).is_closed());
}

TEST_CASE("marching_tetrahedra: values of exactly zero count as outside and stay manifold") {
    const auto plane = [](const Vector3<double>& x) {
        return std::max({x(0) - 2.0, x(1) - 2.0, x(2) - 2.0, -x.sum()});
    };
    const SurfaceMesh mesh = marching_tetrahedra(plane, {-6.0, -6.0, -6.0}, 1.0, {10, 10, 10});
    CHECK(mesh.triangles.size() > 0);
    CHECK(surface_topology(mesh).is_closed());
}

TEST_CASE("marching_tetrahedra: a surface that leaves the lattice is bounded in the lattice's face") {
    const auto sphere = [](const Vector3<double>& x) { return x.norm() - 1.0; };
    const SurfaceMesh mesh = marching_tetrahedra(sphere, {0.0, -1.22, -1.23}, 0.1, {13, 26, 26});
    const SurfaceTopology topology = surface_topology(mesh);
    CHECK(topology.bad == 0);
    CHECK(topology.boundary > 0);
    CHECK(topology.euler() == 1);
    int on_face = 0;
    for (const Vector3<double>& x : mesh.vertices) {
        on_face += x(0) == 0.0 ? 1 : 0;
    }
    CHECK(on_face == topology.boundary);  // one closed loop
}
