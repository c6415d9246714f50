// SPDX-License-Identifier: MIT
#include <softtissue/energy/rest_operators.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("gradients and volumes are the element's", ElementType, Tet4, Prism6) {
    const auto block = solid_block<ElementType>({.n = 2, .noise = 0.1});
    const auto& mesh = block.mesh;
    const auto rest = RestOperators<ElementType, double>::at(mesh, mesh.rest_positions);
    RandomGenerator random(1);
    Matrix3<double> G = random_normal<Matrix3<double>>(random);
    const Matrix3X<double> x = G * mesh.rest_positions;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<ElementType, double> nodes = mesh.rest_nodes(c);
        CHECK(rest.volumes(c) == ElementType::rest_volume(nodes));
        CHECK(rest.cell_gradients(c) == ElementType::gradient_operator(nodes));
        const NodePositions<ElementType, double> moved = mesh.gather(x, mesh.cells.col(c));
        CHECK((moved * rest.cell_gradients(c).transpose() - G).cwiseAbs().maxCoeff() < 1e-12);
    }
    CHECK(rest.volumes.sum() == doctest::Approx(1.0).epsilon(1e-13));

    auto changed = rest;
    changed.update_cell(mesh, 2 * mesh.rest_positions, 3);
    CHECK(changed.volumes(3) == doctest::Approx(8 * rest.volumes(3)).epsilon(1e-13));
    CHECK(changed.volumes(2) == rest.volumes(2));
    CHECK((2 * changed.cell_gradients(3) - rest.cell_gradients(3)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a mirrored shape has negative volumes") {
    const auto block = solid_block<Tet4>({.n = 1});
    const auto rest = RestOperators<Tet4, double>::at(block.mesh, -block.mesh.rest_positions);
    CHECK(rest.volumes.maxCoeff() < 0);
    CHECK(rest.volumes.sum() == doctest::Approx(-1.0).epsilon(1e-13));
}

TEST_CASE_TEMPLATE("lumped masses sum to the mass and have its centre", ElementType, Tet4, Prism6) {
    const auto block = solid_block<ElementType>({.n = 2, .noise = 0.1});
    const VectorX<double> masses = lumped_masses(block.mesh, 1000.0);
    CHECK(masses.minCoeff() > 0);
    CHECK(masses.sum() == doctest::Approx(1000.0).epsilon(1e-13));
    const Vector3<double> first_moment = block.mesh.rest_positions * masses;
    CHECK((first_moment - Vector3<double>::Constant(500)).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("a density that is not positive is refused") {
    const auto block = solid_block<Tet4>({.n = 1});
    CHECK_THROWS_WITH_AS(lumped_masses(block.mesh, -1.0), "density = -1 kg/m^3, expected > 0", InvalidInput);
    CHECK_THROWS_AS(lumped_masses(block.mesh, 0.0), InvalidInput);
    CHECK_THROWS_AS(lumped_masses(block.mesh, std::numeric_limits<double>::infinity()), InvalidInput);
    CHECK_THROWS_AS(lumped_masses(block.mesh, std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}
