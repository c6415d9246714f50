// SPDX-License-Identifier: MIT
// Laplacians, vertex masses, harmonic and biharmonic interpolation on surfaces and volumes.
#include "reference_case.hpp"

#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/harmonic.hpp>
#include <softtissue/mesh/laplacian.hpp>

#include <Eigen/SparseCore>

#include <cstdint>
#include <vector>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double geometry_tolerance = 1e-10;

/// The stored Laplacian has a negative diagonal; ours is positive semi-definite.
void check_laplacian(const ReferenceCase& reference, const Eigen::SparseMatrix<double>& laplacian, Checklist& checks) {
    const Connectivity<2> places = reference.file.at("L_ij").columns<std::int32_t, 2>();
    const VectorX<double> values = reference.file.at("L_val").vector<double>();
    std::vector<Eigen::Triplet<double>> entries;
    for (Index k = 0; k < values.size(); ++k) {
        entries.emplace_back(places(0, k), places(1, k), -values(k));
    }
    Eigen::SparseMatrix<double> expected(laplacian.rows(), laplacian.cols());
    expected.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> difference = laplacian - expected;
    checks.add(reference.name, "cotangent Laplacian",
               difference.coeffs().cwiseAbs().maxCoeff() / values.cwiseAbs().maxCoeff(), geometry_tolerance);
}

void check_interpolation(const ReferenceCase& reference, const Eigen::SparseMatrix<double>& energy,
                         const char* quantity, const char* expected, double allowed, Checklist& checks) {
    const VectorX<std::int32_t> prescribed = reference.file.at("b").vector<std::int32_t>();
    const HarmonicInterpolation<double> interpolation(energy, {prescribed.data(), size_t(prescribed.size())});
    checks.add(reference.name, quantity,
               relative_difference(interpolation.interpolate(reference.file.at("bc").matrix<double>()),
                                   reference.file.at(expected).matrix<double>()),
               allowed);
}

}  // namespace

void check_triangle_geometry(const ReferenceCase& reference, Checklist& checks) {
    const Matrix3X<double> V = reference.points("V");
    const Triangles F = reference.file.at("F").columns<std::int32_t, 3>();
    const Eigen::SparseMatrix<double> laplacian = cotangent_laplacian(V, F);
    const VectorX<double> masses = voronoi_masses(V, F);
    check_laplacian(reference, laplacian, checks);
    checks.add(reference.name, "Voronoi masses",
               relative_difference(masses, reference.file.at("M_voronoi").vector<double>()), geometry_tolerance);
    checks.add(reference.name, "barycentric masses",
               relative_difference(barycentric_masses(V, F), reference.file.at("M_barycentric").vector<double>()),
               geometry_tolerance);
    check_interpolation(reference, laplacian, "harmonic interpolation", "harmonic", geometry_tolerance, checks);
    // the bilaplacian squares the condition number
    check_interpolation(reference, bilaplacian(laplacian, masses), "biharmonic interpolation", "biharmonic", 1e-8,
                        checks);
}

void check_tet_geometry(const ReferenceCase& reference, Checklist& checks) {
    const CellMesh<Tet4, double> mesh{reference.points("X"), reference.file.at("T").columns<std::int32_t, 4>()};
    const Eigen::SparseMatrix<double> laplacian = cotangent_laplacian(mesh);
    check_laplacian(reference, laplacian, checks);
    checks.add(reference.name, "barycentric masses",
               relative_difference(barycentric_masses(mesh), reference.file.at("M_barycentric").vector<double>()),
               geometry_tolerance);
    check_interpolation(reference, laplacian, "harmonic interpolation", "harmonic", geometry_tolerance, checks);
}

}  // namespace reference_check
