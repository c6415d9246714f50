// SPDX-License-Identifier: MIT
#include <softtissue/energy/elastic_energy.hpp>

#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
StableNeoHookean<S> soft() {
    return StableNeoHookean<S>::from_young_poisson({S(1e4), S(0.4)});
}
template <class E, class S>
using Uniform = ElasticEnergy<E, UniformField<StableNeoHookean<S>>>;

}  // namespace

TEST_CASE_TEMPLATE("energy, forces and stiffness are sums over cells", ElementType, Tet4, Prism6) {
    const auto block = solid_block<ElementType>({.n = 2, .noise = 0.05});
    const auto& mesh = block.mesh;
    std::vector<StableNeoHookean<double>> materials;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        materials.push_back(StableNeoHookean<double>::from_young_poisson({1e4 * double(1 + c % 3), 0.3}));
    }
    ElasticEnergy<ElementType, CellField<StableNeoHookean<double>>> elastic(mesh, CellField(materials));
    CHECK(elastic.num_cells() == mesh.num_cells());
    CHECK(elastic.num_vertices() == mesh.num_vertices());
    RandomGenerator random(7);
    const Matrix3X<double> d = random_displacement<double>(mesh.num_vertices(), 0.05, random);
    const Matrix3X<double> x = mesh.rest_positions + d;

    double energy = 0;
    Matrix3X<double> forces = Matrix3X<double>::Zero(3, d.cols());
    MatrixX<double> stiffness = MatrixX<double>::Zero(d.size(), d.size());
    constexpr int num_nodes = ElementType::num_nodes;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const auto X = mesh.rest_nodes(c);
        const auto g = ElementType::gradient_operator(X);
        const double volume = ElementType::rest_volume(X);
        const Matrix3<double> F = mesh.gather(x, mesh.cells.col(c)) * g.transpose();
        CHECK((elastic.deformation_gradient(d, c) - F).norm() < 1e-13);
        const auto& material = materials[size_t(c)];
        energy += volume * material.energy_density(F);
        const Matrix3<double> P = material.first_piola(F);
        const Matrix9<double> H = material.hessian(F);
        MatrixX<double> B = MatrixX<double>::Zero(9, 3 * num_nodes);  // d vec(F) / d nodes
        for (int i = 0; i < num_nodes; ++i) {
            forces.col(mesh.cells(i, c)) += volume * P * g.col(i);
            for (int l = 0; l < 3; ++l) {
                B.block<3, 3>(3 * l, 3 * i) = g(l, i) * Matrix3<double>::Identity();
            }
        }
        const MatrixX<double> K = volume * B.transpose() * MatrixX<double>(H) * B;
        for (int a = 0; a < num_nodes; ++a) {
            for (int b = 0; b < num_nodes; ++b) {
                stiffness.block<3, 3>(3 * mesh.cells(a, c), 3 * mesh.cells(b, c)) += K.block<3, 3>(3 * a, 3 * b);
            }
        }
    }

    const SequentialExecutor executor;
    CHECK(elastic.energy(d, executor) == doctest::Approx(energy).epsilon(1e-13));
    Matrix3X<double> gradient = Matrix3X<double>::Zero(3, d.cols());
    elastic.add_gradient(d, gradient, executor);
    CHECK((gradient - forces).norm() < 1e-12 * forces.norm());
    const PrescribedVertices none(mesh.num_vertices(), {});
    std::vector<std::vector<std::int32_t>> neighbours(size_t(none.num_free()));
    elastic.add_neighbours(none, neighbours);
    BlockMatrix<double> hessian{BlockPattern(std::move(neighbours))};
    elastic.bind(none, hessian.pattern());
    elastic.add_hessian(d, PsdFilter::none, hessian, executor);
    CHECK((hessian.matrix().toDense() - stiffness).norm() < 1e-12 * stiffness.norm());

    // filtered stiffness has no negative direction
    hessian.set_zero();
    elastic.add_hessian(3 * d, PsdFilter::clamp, hessian, executor);
    const MatrixX<double> filtered = hessian.matrix().toDense();
    for (int sample = 0; sample < 50; ++sample) {
        const VectorX<double> v = VectorX<double>::NullaryExpr(d.size(), [&] { return random.normal(); });
        CHECK(v.dot(filtered * v) > -1e-12 * filtered.norm() * v.squaredNorm());
    }
}

TEST_CASE_TEMPLATE("rest is free of forces; an inverted cell is counted", ElementType, Tet4, Prism6) {
    const auto block = solid_block<ElementType>({.n = 1});
    Uniform<ElementType, double> elastic(block.mesh, UniformField{soft<double>()});
    Matrix3X<double> d = Matrix3X<double>::Zero(3, block.mesh.num_vertices());
    Matrix3X<double> gradient = d;
    elastic.add_gradient(d, gradient, SequentialExecutor{});
    CHECK(gradient.norm() < 1e-11);
    CHECK(elastic.count_inverted(d) == 0);
    d.row(0) = -2 * block.mesh.rest_positions.row(0);
    CHECK(elastic.count_inverted(d) == block.mesh.num_cells());
}

TEST_CASE("bad meshes and fields are refused before anything is built") {
    auto mesh = solid_block<Tet4>({.n = 1}).mesh;
    const auto refusal = [](const CellMesh<Tet4, double>& bad) -> std::string {
        try {
            Uniform<Tet4, double> elastic(bad, UniformField{soft<double>()});
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "accepted";
    };
    CHECK(refusal(mesh) == "accepted");
    auto bad = mesh;
    bad.cells(2, 1) = 4000000;
    CHECK(refusal(bad) == "mesh: cell 1, node 2 is vertex 4000000, expected 0 to 7");
    bad.cells(2, 1) = -5;
    CHECK(refusal(bad) == "mesh: cell 1, node 2 is vertex -5, expected 0 to 7");
    bad = mesh;
    std::swap(bad.cells(0, 2), bad.cells(1, 2));
    CHECK(refusal(bad).starts_with("mesh: cell 2 has a rest Jacobian bound of -1, expected > 0"));
    bad = mesh;
    bad.rest_positions(1, 3) = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal(bad) == "mesh: rest position of vertex 3 is not finite");

    using Law = StableNeoHookean<double>;
    CHECK_THROWS_WITH_AS((ElasticEnergy<Tet4, CellField<Law>>(mesh, CellField(std::vector<Law>(2, soft<double>())))),
                         "material field: number of materials = 2, expected one for each of 6 cells", InvalidInput);
}

TEST_CASE_TEMPLATE("nothing is allocated after the first evaluation", Scalar, float, double) {
    const auto block = solid_block<Prism6, Scalar>({.n = 2});
    Uniform<Prism6, Scalar> elastic(block.mesh, UniformField{soft<Scalar>()});
    const PrescribedVertices held(block.mesh.num_vertices(), block.bottom);
    std::vector<std::vector<std::int32_t>> neighbours(size_t(held.num_free()));
    elastic.add_neighbours(held, neighbours);
    BlockMatrix<Scalar> hessian{BlockPattern(std::move(neighbours))};
    elastic.bind(held, hessian.pattern());
    RandomGenerator random(1);
    const Matrix3X<Scalar> d = random_displacement<Scalar>(block.mesh.num_vertices(), 0.1, random);
    Matrix3X<Scalar> gradient = d;
    const SequentialExecutor executor;
    Eigen::internal::set_is_malloc_allowed(false);
    const Scalar energy = elastic.energy(d, executor);
    elastic.add_gradient(d, gradient, executor);
    elastic.add_hessian(d, PsdFilter::absolute, hessian, executor);
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(energy > Scalar(0));
    CHECK(hessian.matrix().norm() > Scalar(0));
}
