// SPDX-License-Identifier: MIT
#include <softtissue/model/human_mesh.hpp>

#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <support/surface_topology.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

using namespace softtissue;

namespace {

const HumanMesh& human() {
    static const HumanMesh mesh = make_human_mesh();
    return mesh;
}

}  // namespace

TEST_CASE("smooth_step: ends, middle, and no velocity or acceleration at the ends; runs backwards too") {
    CHECK(smooth_step(1.0, 3.0, 0.5) == 0.0);
    CHECK(smooth_step(1.0, 3.0, 2.0) == doctest::Approx(0.5));
    CHECK(smooth_step(1.0, 3.0, 9.0) == 1.0);
    CHECK(smooth_step(3.0, 1.0, 1.5) == doctest::Approx(1.0 - smooth_step(1.0, 3.0, 1.5)));
    CHECK(smooth_step(0.0, 1.0, 1e-3) < 1.01e-8);  // 10 t^3
}

TEST_CASE("human mesh: one closed surface of genus 0, outward, of a human's volume, without crossings") {
    const HumanMesh& mesh = human();
    const auto topology = softtissue_test::surface_topology(mesh.faces);
    CHECK(topology.is_closed());
    CHECK(topology.euler() == 2);
    CHECK(Index(topology.vertices) == mesh.num_vertices());
    CHECK(mesh.num_vertices() > 6500);
    CHECK(mesh.num_vertices() < 7500);
    const double volume = enclosed_volume(mesh.vertices, mesh.faces);
    CHECK(volume > 0.050);
    CHECK(volume < 0.090);
    CHECK(crossing_triangles(mesh.vertices, mesh.faces).empty());
    const double height = mesh.vertices.row(1).maxCoeff() - mesh.vertices.row(1).minCoeff();
    CHECK(height > 1.65);
    CHECK(height < 1.80);
    CHECK(std::abs(mesh.vertices.row(1).minCoeff()) < 0.003);  // stands on the floor
}

TEST_CASE("human mesh: mirror images are exact") {
    const HumanMesh& mesh = human();
    std::set<std::vector<Index>> triangles;
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
        std::vector<Index> corners{mesh.faces(0, f), mesh.faces(1, f), mesh.faces(2, f)};
        std::sort(corners.begin(), corners.end());
        triangles.insert(corners);
    }
    for (Index v = 0; v < mesh.num_vertices(); ++v) {
        const Index w = mesh.mirror[size_t(v)];
        CHECK(mesh.mirror[size_t(w)] == v);
        CHECK(mesh.vertices.col(w) == mirrored(mesh.vertices.col(v)));
        CHECK((v == w) == (mesh.vertices(0, v) == 0.0));
    }
    for (const std::vector<Index>& corners : triangles) {
        std::vector<Index> image;
        for (const Index v : corners) {
            image.push_back(mesh.mirror[size_t(v)]);
        }
        std::sort(image.begin(), image.end());
        CHECK(triangles.count(image) == 1);
    }
}

TEST_CASE("human mesh: good triangles everywhere, and edges of the wanted length") {
    const HumanMesh& mesh = human();
    std::vector<double> angles;
    double shortest = 1.0;
    double longest = 0.0;
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
        double smallest = 180.0;
        for (int k = 0; k < 3; ++k) {
            const Vector3<double> a = mesh.vertices.col(mesh.faces(k, f));
            const Vector3<double> u = mesh.vertices.col(mesh.faces((k + 1) % 3, f)) - a;
            const Vector3<double> v = mesh.vertices.col(mesh.faces((k + 2) % 3, f)) - a;
            smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
            shortest = std::min(shortest, u.norm());
            longest = std::max(longest, u.norm());
        }
        angles.push_back(smallest);
    }
    std::sort(angles.begin(), angles.end());
    CHECK(angles.front() > 20.0);
    CHECK(angles[angles.size() / 100] > 35.0);
    CHECK(angles[angles.size() / 2] > 50.0);
    CHECK(shortest > 0.003);
    CHECK(longest < 0.027);
}

TEST_CASE("human mesh: smoothing keeps a constant and shrinks a peak") {
    const HumanMesh& mesh = human();
    MatrixX<double> values = MatrixX<double>::Constant(1, mesh.num_vertices(), 2.0);
    CHECK((mesh.smoothed(values, 3).array() - 2.0).abs().maxCoeff() < 1e-14);
    values(0, 100) = 3.0;
    const MatrixX<double> smooth = mesh.smoothed(values, 1);
    CHECK(smooth(0, 100) == 2.0);
    CHECK(smooth(0, mesh.neighbours()[100].front()) > 2.1);
}
