// SPDX-License-Identifier: MIT
// ctest:
//
// A material of one's own in a few lines: proven by the law suite, then used in a Newton solve.
#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/from_energy.hpp>
#include <softtissue/solver/continuation.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/material_laws.hpp>

#include <cstdio>

using namespace softtissue;

/// Mooney-Rivlin with a penalty on volume; c1, c2 and the bulk modulus k in Pa.
struct MooneyRivlin {
    double c1 = 4e3, c2 = 1e3, k = 2e4;

    template <class S>
    S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
        const Eigen::Matrix<S, 3, 3> C = F.transpose() * F;
        const S J = F.determinant();
        const S I1 = C.trace();
        const S I2 = (I1 * I1 - C.squaredNorm()) / 2.0;
        // the linear term makes the rest state free of stress
        return c1 * (I1 - 3.0) + c2 * (I2 - 3.0) - 2.0 * (c1 + 2.0 * c2) * (J - 1.0) + k / 2.0 * (J - 1.0) * (J - 1.0);
    }
};

/// A cube of n^3 boxes of 1 cm, six tets each.
static CellMesh<Tet4, double> make_cube(int n) {
    const auto vertex = [n](int x, int y, int z) { return std::int32_t((x * (n + 1) + y) * (n + 1) + z); };
    CellMesh<Tet4, double> mesh{Matrix3X<double>(3, (n + 1) * (n + 1) * (n + 1)), Connectivity<4>(4, 6 * n * n * n)};
    constexpr int walks[6][2] = {{4, 6}, {6, 2}, {2, 3}, {3, 1}, {1, 5}, {5, 4}};  // corners (x y z as bits) from 0 to 7
    Index cell = 0;
    for (int x = 0; x <= n; ++x) {
        for (int y = 0; y <= n; ++y) {
            for (int z = 0; z <= n; ++z) {
                mesh.rest_positions.col(vertex(x, y, z)) = 0.01 * Vector3<double>(x, y, z);
                for (int w = 0; w < 6 && x < n && y < n && z < n; ++w) {
                    const auto corner = [&](int bits) { return vertex(x + (bits >> 2), y + (bits >> 1 & 1), z + (bits & 1)); };
                    mesh.cells.col(cell++) << corner(0), corner(walks[w][0]), corner(walks[w][1]), corner(7);
                }
            }
        }
    }
    return mesh;
}

int main() {
    const FromEnergy material{MooneyRivlin{}};
    const LawReport laws = check_material_laws(material, {.is_isotropic = true});
    std::printf("%s\n", laws.summary().c_str());

    const CellMesh<Tet4, double> cube = make_cube(6);
    ElasticEnergy<Tet4, UniformField<FromEnergy<MooneyRivlin>>> elastic(cube, {material});
    Matrix3X<double> d = Matrix3X<double>::Zero(3, cube.num_vertices());
    Matrix3X<double> target = d;
    std::vector<std::int32_t> held;
    for (Index v = 0; v < cube.num_vertices(); ++v) {  // the bottom stays, the top is pulled up by half the height
        const double height = cube.rest_positions(2, v);
        if (height == 0.0 || height == cube.rest_positions.row(2).maxCoeff()) {
            held.push_back(std::int32_t(v));
            target(2, v) = height > 0.0 ? 0.03 : 0.0;
        }
    }
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(cube.num_vertices(), held), executor, elastic);
    DirectSolver<double> linear_solver;
    const SolveReport<double> report = follow_boundary(objective, linear_solver, d, target);
    std::printf("pulled by 30 mm: %s after %d Newton iterations, energy %.4f J\n", to_string(report.status), report.iterations,
                report.energy);
    return laws.all_passed() && report.succeeded() ? 0 : 1;
}
