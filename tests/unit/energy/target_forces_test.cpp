// SPDX-License-Identifier: MIT
#include <softtissue/energy/target_forces.hpp>

#include <softtissue/testing/random_states.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// K = G^T W G, both triangles, of any mesh.
template <class E, class S>
Eigen::SparseMatrix<double> stiffness_of(const CellMesh<E, S>& mesh, const RestOperators<E, S>& rest) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const auto g = rest.cell_gradients(c);
        for (int a = 0; a < E::num_nodes; ++a) {
            for (int b = 0; b < E::num_nodes; ++b) {
                entries.emplace_back(mesh.cells(a, c), mesh.cells(b, c),
                                     double(rest.volumes(c) * g.col(a).dot(g.col(b))));
            }
        }
    }
    Eigen::SparseMatrix<double> K(mesh.num_vertices(), mesh.num_vertices());
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
}

}  // namespace

TEST_CASE_TEMPLATE("the forces of V (T - F) cell by cell, far from the origin too", Block, SolidBlock<Tet4, float>,
                   SolidBlock<Tet4, double>, SolidBlock<Prism6, float>, SolidBlock<Prism6, double>) {
    using E = typename decltype(Block::mesh)::CellElement;
    using S = typename decltype(Block::mesh)::Scalar;
    constexpr int num_nodes = E::num_nodes;
    const auto block = solid_block<E, S>({.n = 3, .plan_noise = 0.1, .noise = 0.05});
    const auto rest = RestOperators<E, S>::at(block.mesh, block.mesh.rest_positions);
    const Index n = block.mesh.num_vertices();
    const PrescribedVertices prescribed(n, block.bottom);
    const TargetForces<S> forces(rest, block.mesh.cells, stiffness_of(block.mesh, rest), prescribed);
    REQUIRE(forces.size() == prescribed.num_free());
    CHECK(forces.num_bytes() > 0);
    RandomGenerator random(3);
    Matrix3X<S> targets(3, 3 * block.mesh.num_cells());
    for (Index k = 0; k < targets.size(); ++k) {
        targets.data()[k] = S(random.normal());
    }
    // exact in float: a translation takes nothing from the positions
    typename TargetForces<S>::Positions x = TargetForces<S>::Positions::Zero(4, n);
    for (Index v = 0; v < n; ++v) {
        for (int k = 0; k < 3; ++k) {
            x(k, v) = S(std::round(1024 * (double(block.mesh.rest_positions(k, v)) + 0.1 * random.normal())) / 1024);
        }
    }
    Matrix3X<double> expected = Matrix3X<double>::Zero(3, n);
    double largest = 0;
    for (Index c = 0; c < block.mesh.num_cells(); ++c) {
        Matrix3<double> missing = targets.template middleCols<3>(3 * c).template cast<double>();
        const Eigen::Matrix<double, 3, num_nodes> g = rest.cell_gradients(c).template cast<double>();
        for (int a = 0; a < num_nodes; ++a) {
            missing -= x.col(block.mesh.cells(a, c)).template head<3>().template cast<double>() * g.col(a).transpose();
        }
        for (int a = 0; a < num_nodes; ++a) {
            const Vector3<double> force = double(rest.volumes(c)) * (missing * g.col(a));
            expected.col(block.mesh.cells(a, c)) += force;
            largest = std::max(largest, force.norm());
        }
    }
    for (const S distance : {S(0), S(64)}) {
        typename TargetForces<S>::Positions moved = x;
        moved.topRows(3).array() += distance;
        Matrix3X<S> found = Matrix3X<S>::Zero(3, n);
        const auto store = [&](Index v, const auto& force) {
            found.col(prescribed.free_vertices()[size_t(v)]) = force.template head<3>();
            CHECK(force(3) == S(0));
        };
        const Index middle = forces.size() / 3;
        forces.for_each(0, middle, targets, moved, prescribed.free_vertices(), store);
        forces.for_each(middle, middle, targets, moved, prescribed.free_vertices(), store);
        forces.for_each(middle, forces.size(), targets, moved, prescribed.free_vertices(), store);
        for (Index v = 0; v < n; ++v) {
            if (prescribed.is_prescribed(v)) {
                CHECK(found.col(v).isZero(S(0)));
            } else {
                CHECK((found.col(v).template cast<double>() - expected.col(v)).norm() <
                      100 * largest * double(std::numeric_limits<S>::epsilon()));
            }
        }
    }
}
