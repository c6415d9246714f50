// SPDX-License-Identifier: MIT
#include <softtissue/model/anatomy_mesh.hpp>

#include <softtissue/mesh/validate_surface.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace softtissue;

namespace {

Vector3<double> on_sphere(double u, double angle, double handedness) {
    const double r = std::sqrt(std::max(0.0, 1.0 - (2 * u - 1) * (2 * u - 1)));
    return {r * std::cos(angle), handedness * r * std::sin(angle), 2 * u - 1};
}

AnatomyMesh<double> nothing() {
    return {"test", AnatomyKind::bone, Matrix3X<double>(3, 0), Triangles(3, 0)};
}

}  // namespace

TEST_CASE("a loft is closed and faces outwards, whatever the chart's handedness") {
    for (const double handedness : {1.0, -1.0}) {
        AnatomyMesh<double> mesh = nothing();
        add_loft(mesh, 20, 30, [&](double u, double angle) { return on_sphere(u, angle, handedness); });
        CHECK(mesh.positions.cols() == 20 * 30 + 2);
        CHECK_NOTHROW(validate_closed_surface(mesh.positions, mesh.triangles, "loft"));
        // An inscribed polyhedron; 30 sectors lose 1 - sin(x)/x = 0.7 %, the rings about as much.
        const double sphere = 4.0 / 3.0 * std::numbers::pi;
        const double volume = enclosed_volume(mesh.positions, mesh.triangles);
        CHECK(volume < sphere);
        CHECK(volume > 0.97 * sphere);
    }
}

TEST_CASE("a second piece follows the first") {
    AnatomyMesh<double> mesh = nothing();
    add_loft(mesh, 5, 8, [&](double u, double angle) { return on_sphere(u, angle, 1.0); });
    const Matrix3X<double> first = mesh.positions;
    const double volume = enclosed_volume(mesh.positions, mesh.triangles);
    add_loft(mesh, 5, 8, [&](double u, double angle) {
        return Vector3<double>(on_sphere(u, angle, 1.0) + Vector3<double>(5, 0, 0));
    });
    CHECK(mesh.positions.leftCols(first.cols()) == first);
    CHECK_NOTHROW(validate_closed_surface(mesh.positions, mesh.triangles, "lofts"));
    CHECK(enclosed_volume(mesh.positions, mesh.triangles) == doctest::Approx(2 * volume).epsilon(1e-12));
}

TEST_CASE("the curve through stations meets them, and is straight where they are") {
    const std::vector<Eigen::Vector2d> stations{{0, 1}, {1, 3}, {2, 5}, {3, 7}, {9, -2}};
    for (size_t i = 0; i < stations.size(); ++i) {
        CHECK((along_stations<2>(stations, double(i) / 4) - stations[i]).norm() < 1e-14);
    }
    CHECK((along_stations<2>(stations, 0.375) - Eigen::Vector2d(1.5, 4)).norm() < 1e-14);
    CHECK((along_stations<2>(stations, -1) - stations.front()).norm() == 0);
    CHECK((along_stations<2>(stations, 2) - stations.back()).norm() < 1e-14);
    CHECK((along_stations<2>({{1, 2}, {3, 4}}, 0.5) - Eigen::Vector2d(2, 3)).norm() < 1e-14);
}

TEST_CASE("rounded ends") {
    CHECK(rounded_ends(0, 0.2) == 0);
    CHECK(rounded_ends(1, 0.2) == 0);
    CHECK(rounded_ends(0.5, 0.2) == 1);
    CHECK(rounded_ends(0.1, 0.2) == doctest::Approx(std::sqrt(0.75)));
    CHECK(rounded_ends(0.9, 0.2) == doctest::Approx(std::sqrt(0.75)));
}
